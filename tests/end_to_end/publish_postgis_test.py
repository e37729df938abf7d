"""Builds in a PostGIS database: twenty nights of changed rows equal a fresh load; nothing half is ever seen; passwords stay unsaid.
Says "not checked" where PostgreSQL or PostGIS are not installed."""
import contextlib
import json
import os
import random
import sqlite3
import struct
import sys

from blockrand_run import SAMPLE, blockrand, extract, main, read_json
from osm_files import read_xml
from postgres_run import Server, missing
from region_run import LIMITS_OFF, Map, RegionTest

LAYERS = {'buildings', 'parts', 'facade_edges', 'blocks', 'courtyards', 'cells', 'surfaces', 'reported', 'tiles'}


class Postgis(RegionTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if reason := missing():
            print(f'not checked: {reason}', file=sys.stderr)
            cls.skipTest(cls, reason)
        cls.server = Server().start()
        cls.addClassCleanup(cls.server.stop)

    def publish(self, source, connection, *arguments, code=0, env=None):
        run = blockrand('publish', source, '--postgis', connection, '--progress', 'none', '--log-format', 'json', *arguments,
                        env=self.server.environment if env is None else env)
        self.assertEqual(run.code, code, run)
        self.assertNotIn('hush-hush', run.out + run.err)
        return json.loads(run.out.splitlines()[-1])['parts'][0].get('figures', {}) if code == 0 else run

    def tables(self, database, schema='blockrand'):
        return {r[0] for r in self.server.sql(database, f"SELECT table_name FROM information_schema.tables WHERE table_schema = '{schema}'")}

    def rows(self, database, table, schema='blockrand'):
        """All rows of a table as texts, without fid, geometries as hexadecimal EWKB; columns by name."""
        columns = sorted(r[0] for r in self.server.sql(
            database, f"SELECT column_name FROM information_schema.columns WHERE table_schema = '{schema}' AND table_name = '{table}'")
            if r[0] not in ('fid', 'loaded'))
        listed = ', '.join(f'"{c}"::text' for c in columns)
        return columns, sorted(map(tuple, self.server.sql(database, f'SELECT {listed} FROM "{schema}"."{table}"')))

    def same_as_fresh(self, source, database):
        """What a fresh database has after one load, row by row."""
        fresh = database + '_fresh'
        self.server.sql('postgres', f'DROP DATABASE IF EXISTS {fresh}')
        self.publish(source, self.server.database(fresh))
        self.assertEqual(self.tables(database), self.tables(fresh))
        for table in sorted(self.tables(fresh)):
            self.assertEqual(self.rows(database, table), self.rows(fresh, table), table)
        return fresh

    def test_twenty_nights_equal_a_fresh_load(self):
        rng, map_ = random.Random(17), Map(read_xml(SAMPLE))
        connection = self.server.database('nights')
        folder = self.region('nights', LIMITS_OFF + f'[build]\nformats = "gpkg"\nreport = false\nsurroundings = "on"\n[publish]\npostgis = "{connection}"\n')
        env = self.server.environment
        self.update(folder, map_.write(self.path('nights.osm')), env=env)
        self.assertLessEqual(LAYERS | {'blockrand_build', 'blockrand_files'}, self.tables('nights'))
        written = []
        for night in range(20):
            map_.random_edits(rng, rng.choice([1, 2, 8]))
            before = self.fids('nights')
            self.update(folder, map_.write_changes(self.path(f'n{night}.osc')), env=env)
            figures = read_json(folder, 'outward', 'last.json')['parts'][0]['figures']
            written.append((figures['rows inserted'], figures['rows unchanged']))
        self.same_as_fresh(folder, 'nights')
        self.equals_the_geopackage('nights', os.path.join(self.current(folder), 'buildings.gpkg'))
        self.assertTrue(any(0 < inserted < unchanged for inserted, unchanged in written), f'rows that did not change are not written: {written}')
        now = self.fids('nights')
        same = before.keys() & now.keys()
        self.assertEqual({row: before[row] for row in same}, {row: now[row] for row in same}, 'unchanged rows keep their fid')
        self.assertGreater(len(same), len(before) // 4)
        build = self.server.sql('nights', 'SELECT name, number, crs FROM blockrand.blockrand_build')
        self.assertEqual(build, [['nights', str(int(os.path.basename(self.current(folder)))), 'EPSG:25832']])
        # Nothing new: no file is read.
        figures = self.publish(folder, connection)
        self.assertEqual((figures['GeoPackages read'], figures['rows inserted']), (0, 0))
        # Back to the build before.
        blockrand('rollback', folder)
        self.publish(folder, connection)
        self.same_as_fresh(folder, 'nights')

    def fids(self, database):
        """{(table, id, hash of the row): fid}"""
        return {(table, *row[:2]): row[2] for table in LAYERS for row in self.server.sql(database, f'SELECT id, blockrand_row, fid FROM blockrand."{table}"')}

    def equals_the_geopackage(self, database, path):
        """Values and geometries of the table are those of the file."""
        with contextlib.closing(sqlite3.connect(path)) as file:
            for table in sorted(LAYERS):
                columns = [r[1] for r in file.execute(f'PRAGMA table_info("{table}")') if r[1] not in ('fid', 'geom')]
                of_file = {}
                for row in file.execute('SELECT ' + ', '.join(f'"{c}"' for c in columns) + f', geom FROM "{table}"'):
                    of_file[row[columns.index('id')]] = row
                listed = ', '.join(f'"{c}"::text' for c in columns)
                there = self.server.sql(database, f'SELECT {listed}, encode(ST_AsBinary(geom, \'NDR\'), \'hex\') FROM blockrand."{table}"')
                self.assertEqual(len(there), len(of_file), table)
                for row in there:
                    for name, text, value in zip(columns, row, of_file[row[columns.index('id')]]):
                        if isinstance(value, float):
                            self.assertAlmostEqual(float(text), value, delta=abs(value) * 1e-14, msg=(table, name))  # GDAL writes 15 digits
                        else:
                            self.assertEqual(text, '' if value is None else str(value), (table, name))
                    blob = of_file[row[columns.index('id')]][-1]
                    if blob is None:
                        self.assertEqual(row[-1], '')
                    else:
                        envelope = (0, 32, 48, 48, 64)[blob[3] >> 1 & 7]
                        self.assertEqual(row[-1], blob[8 + envelope:].hex(), (table, row[0]))

    def test_areas(self):
        source = extract('monaco-2021.osm.pbf')
        if not source:
            self.skipTest('the shared data is absent')
        build = self.build(source, 'areas', '--areas', '13', '--formats', 'gpkg', '--no-report')
        connection = self.server.database('areas')
        figures = self.publish(build, connection)
        areas = set(read_json(build, 'build.json')['areas'])
        self.assertEqual(figures['GeoPackages read'], len(areas))
        self.assertEqual({r[0] for r in self.server.sql('areas', 'SELECT DISTINCT blockrand_area FROM blockrand.buildings')}, areas)
        # The same at once: rows of areas go, and there are as many buildings.
        count = self.server.sql('areas', 'SELECT count(*), count(DISTINCT id) FROM blockrand.buildings')
        # What somebody removed comes back in the rows of all areas, though no file changed.
        self.server.sql('areas', 'DROP TABLE blockrand.parts; ALTER TABLE blockrand.buildings DROP COLUMN storeys')
        figures = self.publish(build, connection)
        self.assertEqual((figures['tables made'], figures['columns added'], figures['GeoPackages read']), (1, 1, len(areas)))
        self.same_as_fresh(build, 'areas')
        whole = self.build(source, 'whole', '--formats', 'gpkg', '--no-report')
        self.refused(self.publish(whole, connection, code=1), 1, 'holds areas, and this is whole', '--schema')
        self.server.sql('areas', "UPDATE blockrand.blockrand_build SET name = 'whole'")  # as the message says
        self.publish(whole, connection)
        self.assertEqual(self.server.sql('areas', 'SELECT count(DISTINCT blockrand_area), max(length(blockrand_area)) FROM blockrand.buildings'), [['1', '0']])
        self.assertEqual(self.server.sql('areas', 'SELECT count(*), count(DISTINCT id) FROM blockrand.buildings'), count)
        self.same_as_fresh(whole, 'areas')

    def test_tables_that_differ(self):
        """Columns of a newer program, tables that somebody removed, changed or made."""
        build = self.build(SAMPLE, 'drift', '--formats', 'gpkg', '--no-report')
        connection, sql = self.server.database('drift'), lambda text: self.server.sql('drift', text)
        self.publish(build, connection)
        indices = {r[0] for r in sql("SELECT indexdef FROM pg_indexes WHERE schemaname = 'blockrand' AND tablename = 'buildings'")}
        self.assertTrue(any('gist' in i for i in indices), indices)
        self.assertIn('Area of the footprint', sql("SELECT col_description('blockrand.buildings'::regclass, attnum) FROM pg_attribute WHERE "
                                                   "attrelid = 'blockrand.buildings'::regclass AND attname = 'footprint_area'")[0][0])
        self.assertEqual(sql('SELECT Find_SRID(\'blockrand\', \'buildings\', \'geom\')'), [['25832']])
        # A column that somebody removed, or that an older program did not have: it comes back with its values.
        sql('ALTER TABLE blockrand.buildings DROP COLUMN footprint_area')
        self.assertEqual(self.publish(build, connection)['columns added'], 1)
        self.same_as_fresh(build, 'drift')
        # Another one more.
        sql('ALTER TABLE blockrand.buildings ADD COLUMN old_one text')
        run = blockrand('publish', build, '--postgis', connection, env=self.server.environment)
        self.assertEqual(run.code, 0, run)
        self.assertIn('no column old_one any more', run.err)
        sql('ALTER TABLE blockrand.buildings DROP COLUMN old_one')
        self.same_as_fresh(build, 'drift')
        # Values that somebody changed: all rows are written anew where that is asked for.
        sql("UPDATE blockrand.buildings SET storeys = 77; DELETE FROM blockrand.tiles")
        self.assertEqual(self.publish(build, connection)['rows inserted'], 0)
        self.assertGreater(self.publish(build, connection, '--resend')['rows inserted'], 0)
        self.same_as_fresh(build, 'drift')
        # A table that was removed is made and loaded, though its file did not change.
        sql('DROP TABLE blockrand.parts')
        self.assertEqual(self.publish(build, connection)['tables made'], 1)
        self.same_as_fresh(build, 'drift')
        # Another type.
        sql("ALTER TABLE blockrand.buildings ALTER COLUMN storeys TYPE real USING 0; UPDATE blockrand.blockrand_files SET sha256 = 'x'")
        self.refused(self.publish(build, connection, code=1), 1, 'column storeys', 'DROP TABLE')
        sql('DROP TABLE blockrand.buildings')
        self.publish(build, connection)
        self.same_as_fresh(build, 'drift')
        # Somebody's table of that name; another schema.
        sql('DROP TABLE blockrand.blocks; CREATE TABLE blockrand.blocks (a integer)')
        self.refused(self.publish(build, connection, code=1), 1, 'did not make it')
        self.publish(build, connection, '--schema', 'Other one')
        self.assertEqual(self.rows('drift', 'buildings', 'Other one'), self.rows('drift', 'buildings'))
        # Another reference system.
        other = self.build(SAMPLE, 'drift_crs', '--formats', 'gpkg', '--no-report', '--crs', 'EPSG:25833')
        self.refused(self.publish(other, connection, '--schema', 'Other one', code=1), 1, 'holds drift, and this is drift_crs')
        sql('UPDATE "Other one".blockrand_build SET name = \'drift_crs\'')
        self.refused(self.publish(other, connection, '--schema', 'Other one', code=1), 1, 'EPSG:25832', 'EPSG:25833')

    def test_what_others_made_stays(self):
        """Views and copies of the tables in their schema have the columns by which this program knows its rows."""
        build = self.build(SAMPLE, 'views', '--formats', 'gpkg', '--no-report')
        connection, sql = self.server.database('views'), lambda text: self.server.sql('views', text)
        self.publish(build, connection)
        before = {t: self.rows('views', t) for t in ('buildings', 'parts')}
        sql('CREATE VIEW blockrand.tall AS SELECT * FROM blockrand.buildings WHERE storeys >= 0; '
            'CREATE VIEW blockrand.joined AS SELECT b.id, b.blockrand_area, p.blockrand_row FROM blockrand.buildings b, blockrand.parts p; '
            'CREATE MATERIALIZED VIEW blockrand.kept AS TABLE blockrand.buildings; '
            'CREATE TABLE blockrand.copied AS TABLE blockrand.buildings')
        shown = {t: self.rows('views', t) for t in ('tall', 'joined', 'copied')}
        self.assertTrue(all(rows for _, rows in shown.values()))
        for again in ("UPDATE blockrand.blockrand_files SET sha256 = 'x'",
                      # An area that the build does not have any more.
                      "INSERT INTO blockrand.blockrand_files VALUES ('areas/1/2/3/buildings.gpkg', 'x', 'buildings')",
                      # A database of a program that had no list of its tables.
                      "DROP TABLE blockrand.blockrand_tables; UPDATE blockrand.blockrand_files SET sha256 = 'x'"):
            sql(again)
            self.publish(build, connection)
            self.assertEqual({t: self.rows('views', t) for t in before}, before, again)
            self.assertEqual({t: self.rows('views', t) for t in shown}, shown, again)
        self.publish(build, connection, '--resend')
        self.assertEqual({t: self.rows('views', t) for t in shown}, shown)
        # A view in the place of a table.
        sql('DROP VIEW blockrand.joined; DROP TABLE blockrand.parts; CREATE VIEW blockrand.parts AS TABLE blockrand.copied')
        self.refused(self.publish(build, connection, code=1), 1, 'parts', 'is there already, and this program did not make it')
        self.assertEqual(self.rows('views', 'copied'), shown['copied'])

    def test_a_second_region_takes_no_rows_of_the_first(self):
        connection = self.server.database('two')
        regions = [self.region(name, LIMITS_OFF + f'[build]\nformats = "gpkg"\nreport = false\n[publish]\npostgis = "{connection}"\n')
                   for name in ('first', 'second')]
        source = Map(read_xml(SAMPLE)).write(self.path('two.osm'))
        self.update(regions[0], source, env=self.server.environment)
        before = self.rows('two', 'buildings')
        run = self.update(regions[1], source, code=6, env=self.server.environment)
        self.assertIn('holds first, and this is second', run.err)
        self.assertIn('--schema', run.err)
        self.assertEqual(self.rows('two', 'buildings'), before)
        self.publish(regions[1], connection, '--schema', 'second')
        self.assertEqual(self.rows('two', 'buildings', 'second'), before)

    def test_what_fails_changes_nothing(self):
        build = self.build(SAMPLE, 'fails', '--formats', 'gpkg', '--no-report')
        connection = self.server.database('fails')
        self.publish(build, connection)
        self.server.sql('fails', "UPDATE blockrand.blockrand_build SET name = 'fails_other'")
        before = {t: self.rows('fails', t) for t in self.tables('fails')}
        # A rule of the database that the rows of another build break, far into the load.
        self.server.sql('fails', "ALTER TABLE blockrand.tiles ADD CONSTRAINT few CHECK (buildings < 0) NOT VALID")
        map_ = Map(read_xml(SAMPLE))
        map_.random_edits(random.Random(2), 40)
        other = self.build(map_.write(self.path('fails.osm')), 'fails_other', '--formats', 'gpkg', '--no-report')
        self.refused(self.publish(other, connection, code=4), 4, 'stays as it was')
        self.assertEqual({t: self.rows('fails', t) for t in self.tables('fails')}, before)
        # No PostGIS; no such database; a wrong password, said in the connection or by the environment.
        plain = self.server.database('plain', postgis=False)
        self.refused(self.publish(build, plain, code=1), 1, 'CREATE EXTENSION postgis')
        self.refused(self.publish(build, self.server.connection('nowhere'), code=4), 4, 'nowhere')
        wrong = connection + ' password=hush-hush-wrong'
        run = self.publish(build, wrong, code=4, env={})
        self.assertIn('password=***', run.err)
        self.server.sql('fails', "UPDATE blockrand.blockrand_build SET name = 'fails'")
        self.publish(build, connection + " password='hush-hush'", env={})
        self.assertNotIn('hush', json.dumps(read_json(build + '.outward', 'last.json')))


if __name__ == '__main__':
    main()
