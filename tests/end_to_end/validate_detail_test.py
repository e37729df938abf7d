"""validate on a build of LoD3: what was built is sound, and what is planted into windows, elements and counts is found."""
import json
import re
import shutil

from blockrand_run import SAMPLE, BuildTest, blockrand, main
from damage import Damaged


def one_corner_up(points):
    points[1][2] += 0.25
    return points


class Detail(BuildTest):
    options = []

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'out', '--lod', '3', '--surroundings', 'off', '--formats', 'citygml,cityjson,gpkg', '--no-report',
                              '--single-cityjson', *cls.options)
        cls.number = 0

    def validate(self, folder):
        run = blockrand('validate', folder, '--json', '--progress', 'none', timeout=3600)
        self.assertIn(run.code, (0, 2), run)
        return json.loads(run.out)

    def damaged(self):
        type(self).number += 1
        return Damaged(self.out, self.path(f'damaged{self.number}'))

    def found(self, damage, codes, *words):
        """At least these codes, and for each word a finding that has it in file, object or detail."""
        damage.seal()
        result = self.validate(damage.folder)
        said = [f"{f['code']} {f['file']} {f['object']}: {f['detail']}" for f in result['findings']]
        shown = '\n'.join(said[:30])
        self.assertLessEqual(set(codes.split()), {f['code'] for f in result['findings']}, shown)
        for word in words:
            self.assertTrue(any(word in line for line in said), f'{word} is named by none of\n{shown}')
        shutil.rmtree(damage.folder)

    def check_soundness(self):
        result = self.validate(self.out)
        self.assertEqual(result['findings'], [])
        self.assertTrue(result['sound'])


class ValidateDetail(Detail):
    options = ['--citygml-detail', 'full']

    def test_what_was_built_is_sound(self):
        self.check_soundness()

    def test_a_wrong_count(self):
        for key in ('windows', 'doors', 'placements', 'installations', 'solids_lod3'):
            d = self.damaged()
            d.json('build.json', lambda b, key=key: b['counts'].update({key: b['counts'][key] + 1}))
            self.found(d, 'COUNTS_DIFFER', f'counts.{key}')

    def test_a_deleted_window(self):
        d = self.damaged()

        def delete(text):
            opening = re.search(r'<bldg:opening><bldg:Window.*?</bldg:opening>', text, re.S).group()
            polygon = re.search(r'xlink:href="#([^"]*)"', opening).group(1)
            text = text.replace(opening, '', 1)
            return re.sub(f'<surfaceMember><Polygon gml:id="{polygon}">.*?</surfaceMember>', '', text, count=1, flags=re.S)
        d.building(delete, lambda text: '<bldg:Window' in text)
        self.found(d, 'SOLID_INVALID COUNTS_DIFFER EXPLANATION_WRONG GEOMETRY_DIFFERS', 'counts.windows',
                   'shell not closed')

    def test_a_moved_vertex(self):
        d = self.damaged()
        d.ring(one_corner_up, 'Window')
        self.found(d, 'CITYGML_RULE SOLID_INVALID GEOMETRY_DIFFERS', 'an edge of it is none of its reveal')

    def test_a_moved_element(self):
        d = self.damaged()
        d.building(lambda text: re.sub(r'(<bldg:Window.*?<pos>)([\d.]+)',
                                       lambda m: m.group(1) + f'{float(m.group(2)) + 8:.4f}', text, count=1, flags=re.S),
                   lambda text: '<bldg:Window' in text)
        self.found(d, 'CITYGML_RULE GEOMETRY_DIFFERS', 'another element, or one at another place')

    def test_a_dangling_link(self):
        d = self.damaged()
        d.replace(d.gml, '<core:relativeGMLGeometry xlink:href="#e', '<core:relativeGMLGeometry xlink:href="#nothing')
        self.found(d, 'CITYGML_RULE', 'which is no element')

    def test_a_template_that_is_missing(self):
        d = self.damaged()
        d.change(d.cityjson, lambda data: re.sub(rb'"template":\d+', b'"template":99999', data, count=1))
        self.found(d, 'CITYJSON_RULE GEOMETRY_DIFFERS', 'a template that does not exist')

    def test_an_installation_of_another_kind(self):
        d = self.damaged()
        d.change(d.cityjson, lambda data: data.replace(b'"function":"chimney"', b'"function":"plinth"', 1))
        self.found(d, 'GEOMETRY_DIFFERS', 'is a chimney against a plinth')


class ValidateLean(Detail):
    """CityGML as it is by default: flat openings with the depth of their reveals, elements on walls alone."""

    def test_what_was_built_is_sound(self):
        self.check_soundness()

    def test_a_wrong_depth(self):
        for pattern in (r'(<bldg:WallSurface [^>]*><gen:doubleAttribute name="reveal_depth"><gen:value>)([\d.]+)',
                        r'(<bldg:(?:Window|Door) [^>]*><gen:doubleAttribute name="reveal_depth"><gen:value>)([\d.]+)'):
            d = self.damaged()
            d.building(lambda text, pattern=pattern: re.sub(pattern, lambda m: f'{m.group(1)}{float(m.group(2)) + 0.02:.3f}',
                                                            text, count=1), re.compile(pattern).search)
            self.found(d, 'GEOMETRY_DIFFERS', 'm behind its wall, it lies')

    def test_a_depth_that_is_none(self):
        d = self.damaged()
        d.replace(d.gml, 'name="reveal_depth"><gen:value>', 'name="reveal_depth"><gen:value>7')
        self.found(d, 'CITYGML_RULE', 'a reveal_depth of')

    def test_a_moved_window(self):
        d = self.damaged()
        d.ring(one_corner_up, 'Window')
        self.found(d, 'CITYGML_RULE SOLID_INVALID GEOMETRY_DIFFERS', 'an edge of it is none of its reveal')

    def test_a_missing_element_and_a_moved_one(self):
        implicit = re.compile('<bldg:outerBuildingInstallation><bldg:BuildingInstallation [^>]*><bldg:function>[^<]*'
                              '</bldg:function>\\s*<bldg:lod3ImplicitRepresentation>(?:(?!</bldg:outerB).)*xlink:href.*?'
                              '</bldg:outerBuildingInstallation>', re.S)
        d = self.damaged()
        d.building(lambda text: implicit.sub('', text, count=1), implicit.search)
        self.found(d, 'GEOMETRY_DIFFERS', 'an element is missing that stands in no opening')
        d = self.damaged()
        d.building(lambda text: implicit.sub(lambda m: re.sub(
            r'(<pos>)([\d.]+)', lambda p: f'{p.group(1)}{float(p.group(2)) + 0.5:.4f}', m.group()), text, count=1),
            implicit.search)
        self.found(d, 'GEOMETRY_DIFFERS', 'another element, or one at another place')

    def test_records_without_their_cityjson_tile(self):
        """What is lean is decided by the format that a tile has, not by those of the build."""
        d = self.damaged()
        name = d.cityjson
        d.remove(name)
        d.seal()
        found = self.validate(d.folder)['findings']
        self.assertNotIn('EXPLANATION_WRONG', {f['code'] for f in found if 'placed elements' in f['detail']}, found[:3])

    def test_a_build_that_says_it_has_everything(self):
        d = self.damaged()
        d.json('build.json', lambda b: b['configuration'].update(citygml_detail='full'))
        self.found(d, 'GEOMETRY_DIFFERS COUNTS_DIFFER', 'counts.placements')


if __name__ == '__main__':
    main()
