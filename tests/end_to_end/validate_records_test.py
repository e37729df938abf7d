"""`blockrand validate` finds each kind of damage planted into build.json, GeoPackage, explanations and reports by what it is.

Every damage is sealed again (hashes and list of files in build.json are those of the damaged files), but for those that
are about hashes and lists.
"""
import re
import sqlite3

from blockrand_run import main
from validate_run import Damages


class BuildRecord(Damages):
    def test_a_wrong_hash(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['files'][d.gml].update(sha256='0' * 64))
        self.found(d, 'FILE_CHANGED', d.gml, seal=False)

    def test_a_flipped_byte(self):
        d = self.damaged()
        d.change('tileset.json', lambda t: t[:-1] + b' ')
        self.found(d, 'FILE_CHANGED', 'tileset.json', seal=False)

    def test_a_truncated_citygml_file(self):
        d = self.damaged()
        d.change(d.gml, lambda t: t[:len(t) // 2])
        self.found(d, 'FILE_UNREADABLE', d.gml)

    def test_a_truncated_glb(self):
        d = self.damaged()
        d.change(d.glb, lambda t: t[:len(t) // 2])
        self.found(d, 'FILE_UNREADABLE', d.glb)

    def test_a_truncated_cityjson_file(self):
        d = self.damaged()
        d.change(d.cityjson, lambda t: t[:len(t) // 2])
        result = self.validate_sealed(d)
        self.assertTrue({f['code'] for f in result['findings']} & {'FILE_UNREADABLE', 'CITYJSON_RULE'}, result['findings'][:5])

    def test_a_missing_file(self):
        d = self.damaged()
        name = d.gml
        d.remove(name)
        self.found(d, 'FILE_MISSING', name, seal=False)

    def test_an_unlisted_file(self):
        d = self.damaged()
        d.write('citygml/old.gml', b'<x/>')
        self.found(d, 'FILE_UNLISTED', 'citygml/old.gml', seal=False)

    def test_damaged_gzip(self):
        d = self.damaged()
        d.change(d.explained, lambda t: t[:len(t) // 2] + b'\0\0\0\0' + t[len(t) // 2 + 4:])
        self.found(d, 'FILE_UNREADABLE', d.explained)

    def test_a_field_that_is_missing(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['counts'].pop('models'))
        self.found(d, 'BUILD_JSON REPORT_WRONG', 'counts.models')

    def test_counts_that_do_not_add_up(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['counts'].update(buildings_in=b['counts']['buildings_in'] + 1))
        self.found(d, 'BUILD_JSON REPORT_WRONG', 'counts')

    def test_a_count_that_no_file_confirms(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['counts'].update(solids_lod2=b['counts']['solids_lod2'] - 1))
        self.found(d, 'COUNTS_DIFFER', 'counts.solids_lod2')

    def test_wrong_statistics(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['statistics']['roofs'].update(gabled=1))
        self.found(d, 'COUNTS_DIFFER', 'statistics.roofs.gabled')

    def test_a_format_that_was_not_asked_for(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['configuration']['formats'].remove('citygml'))
        self.found(d, 'BUILD_JSON', 'citygml/')

    def test_a_pipeline_to_elsewhere(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['crs'].update(pipeline=b['crs']['pipeline'].replace('zone=32', 'zone=33')))
        self.found(d, 'BUILD_JSON GEOMETRY_DIFFERS POSITION', 'crs.pipeline')


class GeoPackage(Damages):
    def test_a_row_that_is_missing(self):
        d = self.damaged()
        d.sql("DELETE FROM parts WHERE id = 'w1020'")
        result = self.validate_sealed(d)
        codes = {f['code'] for f in result['findings']}
        self.assertIn('OBJECT_MISSING', codes)
        self.assertTrue(any(f['object'] == 'w1020' for f in result['findings']))

    def test_a_value_of_the_geopackage(self):
        d = self.damaged()
        d.sql("UPDATE parts SET height = height + 1 WHERE id = 'w1020'")
        self.found(d, 'ATTRIBUTE_DIFFERS', 'buildings.gpkg', 'w1020')

    def test_a_geometry_of_the_geopackage(self):
        d = self.damaged()
        d.sql("UPDATE parts SET geom = (SELECT geom FROM parts WHERE id = 'w1024') WHERE id = 'w1020'")
        result = self.validate_sealed(d)
        found = [f for f in result['findings'] if f['code'] == 'GEOMETRY_DIFFERS']
        self.assertEqual({(f['file'], f['object']) for f in found}, {('buildings.gpkg', 'w1020')})

    def test_a_reported_object_that_is_missing(self):
        d = self.damaged()
        d.sql("DELETE FROM reported WHERE id = 'w9004'")
        result = self.validate_sealed(d)
        self.assertTrue(any(f['code'] == 'OBJECT_MISSING' and f['object'] == 'w9004' for f in result['findings']))

    def test_a_position_in_the_row_that_does_not_exist(self):
        d = self.damaged()
        d.sql("UPDATE buildings SET position = 'lost' WHERE id = 'w1020'")
        self.found(d, 'GEOPACKAGE_RULE', 'buildings.gpkg', 'w1020')

    def test_a_shift_that_contradicts_itself(self):
        d = self.damaged()
        d.sql("UPDATE buildings SET mean_shift = 0.3, max_shift = 0.2 WHERE id = 'w1020'")
        self.found(d, 'GEOPACKAGE_RULE', 'buildings.gpkg', 'w1020')

    def test_an_edge_that_is_missing_and_one_of_another_kind(self):
        d = self.damaged()
        db = sqlite3.connect(d.path('buildings.gpkg'))
        edges = db.execute('SELECT id, building FROM facade_edges ORDER BY fid').fetchall()
        db.close()
        if not edges:
            self.skipTest('this build has no edges')
        (first, _), (second, building) = edges[0], edges[len(edges) // 2]
        d.sql(f"UPDATE facade_edges SET kind = 'garden' WHERE id = '{first}'",
              f"DELETE FROM facade_edges WHERE id = '{second}'")
        found = [f for f in self.validate_sealed(d)['findings'] if f['code'] == 'GEOPACKAGE_RULE']
        self.assertLessEqual({first, building}, {f['object'] for f in found})


class Explanations(Damages):
    def test_an_explanation_that_is_missing(self):
        d = self.damaged()
        gone = []
        d.explanations(lambda records: gone.append(records[0]['id']) or records[1:])
        self.found(d, 'EXPLANATION_WRONG', gone[0])

    def test_an_explanation_of_another_value(self):
        d = self.damaged()

        def change(records):
            for a in records[0]['attributes']:
                if a['name'] == 'height':
                    a['value'] += 3
        d.explanations(change)
        self.found(d, 'EXPLANATION_WRONG', 'height')

    def test_an_index_that_leads_nowhere(self):
        d = self.damaged()
        d.change('explain/index.txt', lambda t: t.replace(b'15_34776_25753', b'15_34776_25754', 1))
        self.found(d, 'EXPLANATION_WRONG', d.explained)

    def test_places_that_say_something_else(self):
        """A name, a height, a place, a line that is gone, and one that is not about anything."""
        def changed(change):
            d = self.damaged()
            d.change('explain/places.tsv', change)
            return d

        def in_first(field, value):
            def change(text):
                first, rest = text.split(b'\n', 1)
                fields = first.split(b'\t')
                fields[field] = value
                return b'\t'.join(fields) + b'\n' + rest
            return change
        for change, what in ((in_first(6, b'Palace'), 'Palace'), (in_first(4, b'99.9'), '99.9'), (in_first(2, b'0.5'), 'stands at'),
                             (in_first(5, b'Other Street 5'), 'Other Street 5'), (in_first(0, b'w99999'), 'is missing'),
                             (lambda t: t.split(b'\n', 1)[1], 'is missing'), (lambda t: b'nonsense\n' + t, 'line 1'),
                             (lambda t: t.split(b'\n', 1)[0] + b'\n' + t, 'twice'),
                             (lambda t: t.split(b'\n', 1)[1] + t.split(b'\n', 1)[0] + b'\n', 'order of ids')):
            self.found(changed(change), 'EXPLANATION_WRONG', what)

    def test_a_report_row_that_is_missing(self):
        d = self.damaged()
        d.json('report.json', lambda r: r['notices'].pop())
        self.found(d, 'COUNTS_DIFFER', 'report.json')

    def test_a_modelled_object_that_is_reported(self):
        d = self.damaged()

        def claim(report):
            row = next(r for r in report['objects'] if r['id'] == 'w9004')
            row['id'] = 'w1020'
        d.json('report.json', claim)
        self.found(d, 'REPORT_WRONG OBJECT_MISSING', 'w1020')

    def test_a_number_on_the_page(self):
        d = self.damaged()
        d.change('report.html', lambda t: re.sub(rb'<b>162</b><span>modelled', b'<b>163</b><span>modelled', t))
        self.found(d, 'REPORT_WRONG', 'modelled', '163')

    def test_an_issue_count_on_the_page(self):
        d = self.damaged()
        d.change('report.html', lambda t: re.sub(rb'(id="code-SPIKE_REMOVED"><summary><span class="count">)\d+', rb'\g<1>9', t))
        self.found(d, 'REPORT_WRONG', 'SPIKE_REMOVED')

    def test_a_page_that_is_not_well_formed(self):
        d = self.damaged()
        d.change('report.html', lambda t: t.replace(b'</section>', b'', 1))
        self.found(d, 'FILE_UNREADABLE', 'report.html')

    def test_a_page_that_loads_from_elsewhere(self):
        d = self.damaged()
        d.change('report.html', lambda t: t.replace(b'</main>', b'<img alt="" src="https://example.org/x.png"/></main>', 1))
        self.found(d, 'REPORT_WRONG', 'example.org')


if __name__ == '__main__':
    main()
