"""Dormers, cross gables and ornamental gables as a user asks for them: by presets, rules of districts and overrides."""
import math
import os
import re
import unittest

import validators
from blockrand_run import SAMPLE, BuildTest, blockrand, files_of, main, read_json

RULES = '''
title = "Roofs"
[[rule]]
name = "all"
level = "city"
preset = "gz_ornate"
parameters = {{ {} }}
'''
LOD3 = ('--lod', '3', '--surroundings', 'off', '--formats', 'gltf,citygml,cityjson,gpkg')


def points(ring):
    """Of a posList, without the repeated last one."""
    numbers = [float(v) for v in ring.split()]
    return [numbers[i:i + 3] for i in range(0, len(numbers) - 3, 3)]


def normal(ring):
    p = [[v - first for v, first in zip(q, points(ring)[0])] for q in points(ring)]
    return [sum((a[k] - b[k]) * (a[m] + b[m]) for a, b in zip(p, p[1:] + p[:1])) for k, m in ((1, 2), (2, 0), (0, 1))]


class RoofElements(BuildTest):
    def with_parameters(self, name, parameters, *options):
        rules = self.place(name + '.toml', RULES.format(parameters))
        return self.build(SAMPLE, name, *LOD3, '--districts', rules, *options)

    def counts(self, out):
        return read_json(out, 'build.json')['counts']

    def gml(self, out):
        text = ''
        for name in sorted(files_of(out, '.gml')):
            with open(os.path.join(out, name), encoding='utf-8') as f:
                text += f.read()
        return text

    def test_a_district_orders_dormers(self):
        bare = self.with_parameters('bare', 'dormer_share = 0, cross_gable_share = 0, gable_window_share = 0')
        self.assertEqual((self.counts(bare)['dormers'], self.counts(bare)['cross_gables']), (0, 0))
        full = self.with_parameters('full', 'dormer_share = 1, dormer_kind = "shed", dormer_every = 1, cross_gable_share = 0, gable_window_share = 0')
        dormers = self.counts(full)['dormers']
        self.assertGreater(dormers, 20)
        # Each has its window; LoD2 is what it was.
        more = self.counts(full)['windows'] - self.counts(bare)['windows']
        self.assertGreaterEqual(more, 0.95 * dormers)
        self.assertLessEqual(more, dormers)
        lod2 = [dict(re.findall(r'<Polygon gml:id="([wr][0-9.a-z]*_p\d+)">(.*?)</Polygon>', self.gml(out), re.S)) for out in (bare, full)]
        self.assertGreater(len(lod2[0]), 100)
        self.assertEqual([i for i in lod2[0].keys() | lod2[1].keys() if lod2[0].get(i) != lod2[1].get(i)], [])
        self.assertEqual(validators.xmllint(full), '')
        self.assertEqual(validators.khronos(full), '')
        checked = blockrand('validate', full)
        self.assertEqual(checked.code, 0, checked)

    def test_cross_gables_gables_and_what_explain_says(self):
        out = self.with_parameters('gables', 'dormer_share = 0, cross_gable_share = 1, cross_gable_width = 2.4, gable = "stepped"')
        self.assertGreater(self.counts(out)['cross_gables'], 3)
        self.assertEqual(self.counts(out)['dormers'], 0)
        checked = blockrand('validate', out)
        self.assertEqual(checked.code, 0, checked)
        ids = re.findall(r'<bldg:Building gml:id="(w\d+)"', self.gml(out))
        told = [blockrand('explain', out, id_).out for id_ in ids[:60]]
        self.assertTrue(any('cross gable' in text for text in told))

    def test_edges_are_ordered(self):
        bare = 'dormer_share = 0, cross_gable_share = 0, '
        usual = self.gml(self.with_parameters('usual', bare + 'gable = "none"'))
        none = self.gml(self.with_parameters('none', bare + 'eaves_overhang = 0, verge_overhang = 0, parapet_height = 0, ridge_caps = 0'))
        for kind in ('eaves', 'ridge_cap'):  # bodies beside the main one keep theirs
            self.assertGreater(usual.count(f'>{kind}<'), 20, kind)
            self.assertLess(none.count(f'>{kind}<'), usual.count(f'>{kind}<') / 2, kind)
        wide = self.with_parameters('wide', bare + 'eaves_overhang = 0.1, verge_overhang = 0.6, parapet_height = 1.1')
        self.assertGreaterEqual(self.gml(wide).count('>verge<'), usual.count('>verge<'))
        checked = blockrand('validate', wide)  # no body in another
        self.assertEqual(checked.code, 0, checked)

    def test_gutters_are_ordered(self):
        bare = 'dormer_share = 0, cross_gable_share = 0, '
        usual = self.with_parameters('gutters', bare + 'gutters = 1, downpipes = 1')
        none = self.with_parameters('no_gutters', bare + 'gutters = 0')
        for kind in ('gutter', 'downpipe'):  # bodies beside the main one keep theirs
            self.assertGreater(self.gml(usual).count(f'>{kind}<'), 20, kind)
            self.assertLess(self.gml(none).count(f'>{kind}<'), self.gml(usual).count(f'>{kind}<') / 2, kind)
        self.assertNotIn('>downpipe<', self.gml(self.with_parameters('as_usual', bare + 'gable = "none"')))
        self.assertEqual(validators.xmllint(usual), '')
        self.assertEqual(validators.khronos(usual), '')
        checked = blockrand('validate', usual)
        self.assertEqual(checked.code, 0, checked)

    def told(self, out, code):
        report = read_json(out, 'report.json')
        return sorted({row['id'] for part in ('objects', 'fallbacks', 'notices') for row in report[part] if row.get('code') == code})

    def side_pitches(self, out, way):
        """Of the LoD2 roof faces of a building, by where they look: degrees, from the written file."""
        found = re.search(rf'<bldg:Building gml:id="{way}">.*?</bldg:Building>', self.gml(out), re.S).group(0)
        pitches = {}
        for ring in re.findall(r'posList[^>]*>([^<]*)<', found):
            n = normal(ring)
            flat = math.hypot(n[0], n[1])
            if flat > 1e-6 and n[2] > 0.05 * flat:  # no wall, no floor
                side = ('north' if n[1] > 0 else 'south') if abs(n[1]) >= abs(n[0]) else ('east' if n[0] > 0 else 'west')
                pitches.setdefault(side, set()).add(round(math.degrees(math.atan2(flat, n[2]))))
        return pitches

    HOUSE = '''<osm version="0.6"><node id="1" lat="52.5200" lon="13.4000"/><node id="2" lat="52.5200" lon="13.4002"/>
<node id="3" lat="52.5201" lon="13.4002"/><node id="4" lat="52.5201" lon="13.4000"/>
<way id="9"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="house"/>
<tag k="building:levels" v="2"/><tag k="roof:shape" v="{}"/>{}</way></osm>'''

    def test_sides_of_a_roof_have_pitches_of_their_own(self):
        ordered = '<tag k="blockrand:roof_pitches" v="south 60, north 30"/>'
        out = self.build(self.place('tagged.osm', self.HOUSE.format('hipped', ordered)), 'tagged', '--lod', '2', '--formats', 'citygml')
        pitches = self.side_pitches(out, 'w9')
        self.assertEqual((pitches['south'], pitches['north']), ({60}, {30}))
        self.assertEqual(pitches['east'], pitches['west'])
        self.assertIn('south 60, north 30', blockrand('explain', out, 'w9', '--all').out)
        overrides = self.place('pitches.toml', '[w9]\nroof_pitches = "east 70, south 20"\n')
        out = self.build(self.place('plain.osm', self.HOUSE.format('hipped', '')), 'ordered', '--lod', '2', '--formats', 'citygml',
                         '--overrides', overrides)
        pitches = self.side_pitches(out, 'w9')
        self.assertEqual((pitches['east'], pitches['south']), ({70}, {20}))
        self.assertNotIn(pitches['west'], ({70}, {20}))
        rules = self.place('pitches_rules.toml', '''title = "Pitches"
[presets.steep_north]
description = "A preset of a test"
class = "gruenderzeit"
grammar = "gruenderzeit.cga"
[presets.steep_north.measures]
roof_pitches = "north 65"
[[rule]]
name = "all"
level = "city"
preset = "steep_north"
''')
        out = self.build(self.place('preset.osm', self.HOUSE.format('hipped', '')), 'by_preset', '--lod', '2', '--formats', 'citygml',
                         '--districts', rules)
        self.assertEqual(self.side_pitches(out, 'w9')['north'], {65})
        # What no side has, and what cannot be read, is told.
        for name, shape, value, code in (('flat', 'flat', 'south 60', 'SIDE_PITCH_UNREAD'), ('mansard', 'mansard', 'south 60', 'SIDE_PITCH_UNREAD'),
                                         ('street', 'hipped', 'street 60', 'SIDE_PITCH_UNREAD'), ('front', 'hipped', 'front 60', 'VALUE_UNREADABLE')):
            tag = f'<tag k="blockrand:roof_pitches" v="{value}"/>'
            out = self.build(self.place(name + '.osm', self.HOUSE.format(shape, tag)), name, '--lod', '2', '--formats', 'citygml')
            self.assertEqual(self.told(out, code), ['w9'], name)
        # A height against them is told, and an order for an outline whose parts have the roofs.
        tag = '<tag k="blockrand:roof_pitches" v="south 60, north 30"/>'
        out = self.build(self.place('low.osm', self.HOUSE.format('hipped', tag + '<tag k="roof:height" v="1"/>')), 'low', '--lod', '2', '--formats', 'citygml')
        self.assertEqual(self.told(out, 'SIDE_PITCH_UNREAD'), ['w9'])
        parts = self.HOUSE.format('hipped', tag).replace('</osm>', '''<way id="10"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/>
<tag k="building:part" v="yes"/><tag k="building:levels" v="2"/></way></osm>''')
        out = self.build(self.place('parts.osm', parts), 'parts', '--lod', '2', '--formats', 'citygml')
        self.assertEqual(self.told(out, 'SIDE_PITCH_UNREAD'), ['w9'])
        good = self.build(self.place('good.osm', self.HOUSE.format('hipped', tag)), 'good', '--lod', '2', '--formats', 'citygml')
        self.assertEqual(self.told(good, 'SIDE_PITCH_UNREAD') + self.told(good, 'VALUE_UNREADABLE'), [])
        # What is tagged beats what a preset states.
        out = self.build(self.place('angle.osm', self.HOUSE.format('hipped', '<tag k="roof:angle" v="25"/>')), 'angle', '--lod', '2', '--formats', 'citygml',
                         '--districts', rules)
        self.assertEqual(self.side_pitches(out, 'w9'), {side: {25} for side in ('north', 'east', 'south', 'west')})

    def test_windows_of_gables_take_outlines(self):
        wide = 'dormer_share = 1, dormer_kind = "gabled", cross_gable_share = 0, roof_window_outline = "{}"'
        plain = self.with_parameters('straight', wide.format('straight'))
        count = self.counts(plain)['windows']
        for outline, corners in (('circular', 16), ('ogee', 12), ('round', 9)):
            out = self.with_parameters(outline, wide.format(outline))
            self.assertGreaterEqual(self.counts(out)['windows'], 0.99 * count, outline)
            text = self.gml(out)
            rings = dict(re.findall(r'<Polygon gml:id="([^"]+)">.*?posList[^>]*>([^<]*)<', text, re.S))
            panes = [points(rings[ref]) for ref in re.findall(r'<bldg:Window .*?href="#([^"]+)".*?</bldg:Window>', text, re.S)]
            self.assertGreater(sum(len(p) >= corners for p in panes), 20, outline)
            checked = blockrand('validate', out)
            self.assertEqual(checked.code, 0, checked)

    def test_windows_take_outlines(self):
        self.place('outlines.cga', '''version "2025.1"
@StartRule
Facade --> case scope.sx < 3 || scope.sy < 4 : Wall. else : split(x){ ~1 : Wall. | { 1.2 : Column(split.index) | ~0.8 : Wall. }* }
Column(i) --> split(y){ 1 : Wall. | 2.4 : Opening(floor(i / 2) % 3) | ~1 : Wall. }
Opening(n) -->
	case n == 0 : blockrand.window("shaped_window", "top", "ogee", "top_size", 0.4, "upright_bars", 1)
	case n == 1 : blockrand.window("shaped_window", "outline", "circular", "surround", "plain")
	else : blockrand.window("shaped_window", "top_left", 0.2, "top_right", 0.2, "left_above", 0.1, "right_above", 0.1)
''')
        rules = self.place('outlines.toml', '''title = "Outlines"
[presets.shaped]
description = "A preset of a test"
class = "gruenderzeit"
grammar = "outlines.cga"
roof_grammar = ""
[[rule]]
name = "all"
level = "city"
preset = "shaped"
''')
        out = self.build(SAMPLE, 'outlines', *LOD3, '--districts', rules)
        self.assertGreater(self.counts(out)['windows'], 500)
        # The glass of each kind as it is written: corners that turn in, round ones, cut ones.
        hollow = round_ = cut = 0
        text = self.gml(out)
        rings = dict(re.findall(r'<Polygon gml:id="([^"]+)">.*?posList[^>]*>([^<]*)<', text, re.S))
        for window in re.findall(r'<bldg:Window .*?</bldg:Window>', text, re.S):
            ring = rings[re.search(r'href="#([^"]+)"', window).group(1)]
            p, n = points(ring), normal(ring)
            turns = 0
            for a, b, c in zip(p, p[1:] + p[:1], p[2:] + p[:2]):
                u, v = [b[k] - a[k] for k in range(3)], [c[k] - b[k] for k in range(3)]
                cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
                turns += sum(cross[k] * n[k] for k in range(3)) < -1e-6
            hollow += turns > 0
            round_ += turns == 0 and len(p) >= 12
            cut += turns == 0 and len(p) == 6
        for count in (hollow, round_, cut):
            self.assertGreater(count, 100, (hollow, round_, cut))
        self.assertEqual(validators.xmllint(out), '')
        self.assertEqual(validators.khronos(out), '')
        checked = blockrand('validate', out)
        self.assertEqual(checked.code, 0, checked)

    def test_what_is_wrong_is_told(self):
        out = self.with_parameters('wrong', 'dormer_share = 1, dormer_kind = "pagoda", cross_gable_share = 0')
        self.assertEqual(self.counts(out)['dormers'], 0)
        report = read_json(out, 'report.json')
        details = [row.get('detail', '') for part in ('objects', 'fallbacks', 'notices') for row in report[part]
                   if row.get('code') == 'GRAMMAR_ERROR']
        self.assertTrue(any('dormer_kind' in d and 'pagoda' in d for d in details), details[:3])


if __name__ == '__main__':
    main()
