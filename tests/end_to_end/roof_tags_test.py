"""Roof tags from the file to the model: ridges and hips that are drawn, tags that contradict each other."""
import validators
from blockrand_run import BuildTest, main, read_json
from osm_files import METRE, Node, Way, write_xml

LON, LAT = 11.0, 51.5
STRETCH = 1.606  # 1 / cos(latitude)


def node(id, x, y, tags=None):
    """x east, y north, in metres."""
    return Node(id, LON + x * METRE * STRETCH, LAT + y * METRE, tags)


def drawn_house(first, x, tags):
    """20 by 10 m; node `first` + 4 in the middle of the western gable."""
    nodes = [node(first, x, 0), node(first + 1, x + 20, 0), node(first + 2, x + 20, 10), node(first + 3, x, 10), node(first + 4, x, 5)]
    outline = [first, first + 1, first + 2, first + 3, first + 4, first]
    return nodes + [Way(first, outline, {'building': 'house', 'building:levels': '2', **tags})]


class RoofTags(BuildTest):
    def make(self, name, objects):
        out = self.build(write_xml(self.path(name + '.osm'), objects), name)
        self.counts_add_up(out)
        self.assertEqual(validators.problems(out), '')
        return out

    def said(self, out):
        report = read_json(out, 'report.json')
        return sorted((r['id'], r['code'], r['detail']) for r in report['notices'] + report['fallbacks']
                      if r['code'] != 'COLLINEAR_POINTS')

    def test_ridge_from_a_gable_to_a_hip(self):
        objects = drawn_house(100, 0, {'roof:height': '4'})
        objects += [node(110, 14, 5), Way(110, [104, 110], {'roof:ridge': 'yes'}), Way(111, [101, 110, 102], {'roof:edge': 'yes'})]
        out = self.make('ridge', objects)
        self.assertEqual(self.said(out), [])
        self.assertEqual(read_json(out, 'build.json')['statistics']['roofs'], {'lined': 1})

    def test_lines_that_make_no_roof(self):
        objects = drawn_house(100, 0, {'roof:height': '4', 'roof:shape': 'hipped'})
        objects += [node(110, 14, 5), node(111, 5, 2), node(112, 5, 8), Way(110, [104, 110], {'roof:ridge': 'yes'}),
                    Way(111, [111, 112], {'roof:edge': 'yes'})]  # crosses the ridge without a node
        objects += drawn_house(200, 60, {'roof:shape': 'flat'}) + [node(210, 74, 5), Way(210, [204, 210], {'roof:ridge': 'yes'})]
        out = self.make('no-roof', objects)
        self.assertEqual(self.said(out), [
            ('w100', 'ROOF_LINES_IGNORED', 'w100: they do not fit each other or the plan'),
            ('w200', 'VALUES_CONFLICT', 'mapped ridges against roof:shape=flat: the shape won')])
        self.assertEqual(read_json(out, 'build.json')['statistics']['roofs'], {'flat': 1, 'hipped': 1})

    def test_contradictions(self):
        out = self.make('conflicts',
                        drawn_house(100, 0, {'roof:shape': 'gabled', 'roof:angle': '45', 'roof:height': '2'})
                        + drawn_house(200, 60, {'roof:shape': 'gabled', 'roof:direction': 'E', 'roof:orientation': 'along'})
                        + drawn_house(300, 120, {'roof:shape': 'skillion', 'roof:angle': '10', 'roof:direction': 'E'}))
        self.assertEqual(self.said(out), [
            ('w100', 'VALUES_CONFLICT', 'roof:height=2 against roof:angle=45, which gives 5.0 m: roof:height won'),
            ('w200', 'VALUES_CONFLICT', 'roof:direction=90 falls along the longer side against roof:orientation=along: roof:direction won')])


if __name__ == '__main__':
    main()
