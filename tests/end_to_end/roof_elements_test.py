"""Dormers, cross gables and ornamental gables as a user asks for them: by presets, rules of districts and overrides."""
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
LOD3 = ('--lod', '3', '--formats', 'gltf,citygml,cityjson,gpkg')


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

    def test_what_is_wrong_is_told(self):
        out = self.with_parameters('wrong', 'dormer_share = 1, dormer_kind = "pagoda", cross_gable_share = 0')
        self.assertEqual(self.counts(out)['dormers'], 0)
        report = read_json(out, 'report.json')
        details = [row.get('detail', '') for part in ('objects', 'fallbacks', 'notices') for row in report[part]
                   if row.get('code') == 'GRAMMAR_ERROR']
        self.assertTrue(any('dormer_kind' in d and 'pagoda' in d for d in details), details[:3])


if __name__ == '__main__':
    main()
