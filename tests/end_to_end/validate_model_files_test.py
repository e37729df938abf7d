"""`blockrand validate` finds each kind of damage planted into CityGML and CityJSON by what it is.

Every damage is sealed again (hashes and list of files in build.json are those of the damaged files), but for those that
are about hashes and lists.
"""
import json
import os
import re

from blockrand_run import Setup, main
from validate_run import Damages


class CityGml(Damages):
    def test_a_flipped_face(self):
        d = self.damaged()
        result = self.found(d, 'SOLID_INVALID GEOMETRY_DIFFERS', d.ring(lambda r: r[::-1]), '307 polygon wrong orientation')
        self.assertIn(307, [f.get('number') for f in result['findings']])

    def test_a_moved_corner(self):
        d = self.damaged()

        def move(ring):
            ring[0][2] -= 0.5
            ring[-1][2] -= 0.5
            return ring
        self.found(d, 'SOLID_INVALID GEOMETRY_DIFFERS', d.ring(move), '203 not planar')

    def test_a_corner_off_the_grid(self):
        d = self.damaged()

        def nudge(ring):
            ring[0][2] -= 0.0004
            ring[-1][2] -= 0.0004
            return ring
        self.found(d, 'OFF_GRID', d.ring(nudge))

    def test_a_moved_building(self):
        """One building, an eighth of a metre to the west: still a sound solid, and still in the envelope."""
        d = self.damaged()

        def move(text):
            def shift(found):
                n = found.group(2).split()
                return found.group(1) + ' '.join(f'{float(v) - 0.125:.4f}' if i % 3 == 0 else v for i, v in enumerate(n))
            return re.sub(r'(<posList>)([^<]*)', shift, text)
        west = float(re.search(r'<lowerCorner>([0-9.]*)', d.read(d.gml).decode()).group(1))
        building = d.building(move, lambda text: all(float(x) > west + 1 for x in re.findall(r'<posList>([0-9.]*)', text))
                              and 'gml:id="w1020"' in text)
        self.found(d, 'GEOMETRY_DIFFERS POSITION', building)

    def test_swapped_axes(self):
        d = self.damaged()

        def swap(data):
            def turn(found):
                n = found.group(2).split()
                return found.group(1) + ' '.join(v for i in range(0, len(n), 3) for v in (n[i + 1], n[i], n[i + 2]))
            return re.sub(r'(<posList>|<lowerCorner>|<upperCorner>)([^<]*)', turn, data.decode()).encode()
        d.change(d.gml, swap)
        self.found(d, 'SOLID_INVALID GEOMETRY_DIFFERS POSITION', d.gml)

    def test_an_open_solid(self):
        d = self.damaged()

        def drop(text):
            at = text.index('<bldg:lod1Solid>')
            start = text.index('<surfaceMember>', at)
            end = text.index('</surfaceMember>', start) + len('</surfaceMember>')
            return text[:start] + text[end:]
        self.found(d, 'SOLID_INVALID GEOMETRY_DIFFERS', d.building(drop), '302 shell not closed')

    def test_a_building_that_is_missing(self):
        d = self.damaged()
        building = d.building(lambda text: '')
        self.found(d, 'OBJECT_MISSING COUNTS_DIFFER EXPLANATION_WRONG REPORT_WRONG CITYGML_RULE', building)

    def test_a_building_that_stands_twice(self):
        d = self.damaged()
        building = d.building(lambda text: text + text)
        self.found(d, 'CITYGML_RULE OBJECT_DOUBLED COUNTS_DIFFER EXPLANATION_WRONG', building)

    def test_a_wrong_reference_system(self):
        d = self.damaged()
        d.change(d.gml, lambda t: re.sub(rb'srsName="[^"]*"', b'srsName="urn:ogc:def:crs:EPSG::25831"', t))
        self.found(d, 'CITYGML_RULE', 'EPSG::25831')

    def test_a_reference_to_nowhere(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'xlink:href="#[^"]*"', 'xlink:href="#nowhere"', text, count=1))
        self.found(d, 'CITYGML_RULE', building, '#nowhere')  # of a surface; the solid has its polygons itself

    def test_an_open_ring(self):
        d = self.damaged()
        self.found(d, 'CITYGML_RULE SOLID_INVALID GEOMETRY_DIFFERS', d.ring(lambda r: r[:-1]), '103 ring not closed')

    def test_an_unknown_source(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'(name="height_source"><gen:value>)[^<]*', r'\1guess', text), lambda t: 'name="height_source"' in t)
        self.found(d, 'SOURCE_WRONG ATTRIBUTE_DIFFERS EXPLANATION_WRONG COUNTS_DIFFER', building, 'guess')

    def test_a_confidence_above_one(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'(name="height_confidence"><gen:value>)[^<]*', r'\g<1>1.5', text), lambda t: 'name="height_confidence"' in t)
        self.found(d, 'SOURCE_WRONG ATTRIBUTE_DIFFERS', building, '1.5')

    def test_a_number_that_is_none(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'(name="roof_height"><gen:value>)[^<]*', r'\1high', text), lambda t: 'name="roof_height"' in t)
        self.found(d, 'CITYGML_RULE ATTRIBUTE_DIFFERS EXPLANATION_WRONG', building, 'high')

    def test_an_attribute_of_citygml(self):
        d = self.damaged()
        building = d.building(lambda text: re.sub(r'(<bldg:storeysAboveGround>)\d+', r'\g<1>77', text), lambda t: '<bldg:storeysAboveGround>' in t)
        self.found(d, 'ATTRIBUTE_DIFFERS EXPLANATION_WRONG', building, '77')

    def test_a_colour_of_citygml(self):
        d = self.damaged()
        d.change(d.gml, lambda t: re.sub(rb'(<app:diffuseColor>)[^<]*', rb'\g<1>1 0 1', t, count=1))
        self.found(d, 'COLOUR_DIFFERS', '#ff00ff')

    def test_a_colour_that_is_none(self):
        d = self.damaged()
        d.change(d.gml, lambda t: re.sub(rb'(<app:diffuseColor>)[^<]*', rb'\g<1>1 2 3', t, count=1))
        self.found(d, 'CITYGML_RULE', 'colour')

    def test_an_appearance_of_nothing(self):
        d = self.damaged()
        d.change(d.gml, lambda t: re.sub(rb'(<app:target>)[^<]*', rb'\g<1>#nothing', t, count=1))
        self.found(d, 'CITYGML_RULE', '#nothing')

    def test_an_envelope_that_is_too_small(self):
        d = self.damaged()

        def lower(data):
            found = re.search(rb'<upperCorner>([^<]*)', data)
            x, y, z = found.group(1).split()
            return data[:found.start(1)] + b'%s %s %.4f' % (x, y, float(z) - 1) + data[found.end(1):]
        d.change(d.gml, lower)
        self.found(d, 'CITYGML_RULE', 'envelope')

    def test_an_element_that_does_not_exist(self):
        d = self.damaged()
        d.change(d.gml, lambda t: t.replace(b'bldg:roofType', b'bldg:roofKind'))
        self.found(d, 'CITYGML_RULE', 'roofKind')

    def test_elements_out_of_order(self):
        """What only the schema knows."""
        schemas = os.path.join(Setup.shared or '', 'schemas')
        if not os.path.exists(os.path.join(schemas, 'citygml2.xsd')):
            self.skipTest('no CityGML schemas')
        d = self.damaged()

        def swap(text):
            found = re.search(r'(<bldg:measuredHeight[^>]*>[^<]*</bldg:measuredHeight>\s*)(<bldg:storeysAboveGround>[^<]*</bldg:storeysAboveGround>)', text)
            return text[:found.start()] + found.group(2) + found.group(1) + text[found.end():]
        d.building(swap, lambda t: '<bldg:storeysAboveGround>' in t)
        self.found(d, 'CITYGML_SCHEMA', d.gml, options=('--schemas', schemas))


class CityJson(Damages):
    def feature(self, d, change, wanted=lambda f: True):
        """Changes the first feature that `wanted` accepts; None from `change` drops it. Returns its id."""
        lines = d.read(d.cityjson).decode().splitlines()
        for i, line in enumerate(lines[1:], 1):
            feature = json.loads(line)
            if not wanted(feature):
                continue
            changed = change(feature)
            lines[i:i + 1] = [] if changed is None else [json.dumps(changed, ensure_ascii=False, separators=(',', ':'))]
            d.write(d.cityjson, ''.join(line + '\n' for line in lines).encode())
            return feature['id']
        raise AssertionError('no such feature')

    def test_a_child_without_parent(self):
        d = self.damaged()

        def orphan(f):
            for o in f['CityObjects'].values():
                o.pop('parents', None)
            return f
        d_id = self.feature(d, orphan, lambda f: len(f['CityObjects']) > 1)
        result = self.validate_sealed(d)
        self.assertIn('CITYJSON_RULE', {f['code'] for f in result['findings']})
        self.assertTrue(any(d_id in f['object'] for f in result['findings']))

    def test_a_vertex_that_does_not_exist(self):
        d = self.damaged()

        def point_beyond(f):
            geometry = [g for o in f['CityObjects'].values() for g in o.get('geometry', []) if g['type'] == 'Solid'][0]
            geometry['boundaries'][0][0][0][0] = 99999
            return f
        self.feature(d, point_beyond)
        result = self.validate_sealed(d)
        self.assertIn('CITYJSON_RULE', {f['code'] for f in result['findings']})

    def test_another_kind_of_surface(self):
        d = self.damaged()

        def rename(f):
            for o in f['CityObjects'].values():
                for g in o.get('geometry', []):
                    for s in g.get('semantics', {}).get('surfaces', []):
                        if s['type'] == 'RoofSurface':
                            s['type'] = 'OuterFloorSurface'
            return f
        changed = self.feature(d, rename)
        self.found(d, 'GEOMETRY_DIFFERS', changed, 'outer_floor')

    def test_a_feature_that_is_missing(self):
        d = self.damaged()
        dropped = self.feature(d, lambda f: None)
        result = self.validate_sealed(d)
        codes = {f['code'] for f in result['findings']}
        self.assertLessEqual({'OBJECT_MISSING', 'COUNTS_DIFFER'}, codes)
        self.assertTrue(any(dropped == f['object'] for f in result['findings'] if f['code'] == 'OBJECT_MISSING'))

    def test_a_scale_that_is_wrong(self):
        d = self.damaged()

        def stretch(data):
            first, rest = data.split(b'\n', 1)
            head = json.loads(first)
            head['transform']['scale'] = [0.001] * 3
            return json.dumps(head).encode() + b'\n' + rest
        d.change(d.cityjson, stretch)
        codes = {f['code'] for f in self.validate_sealed(d)['findings']}
        self.assertLessEqual({'GEOMETRY_DIFFERS', 'POSITION'}, codes)


if __name__ == '__main__':
    main()
