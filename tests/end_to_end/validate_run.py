"""What the tests of `blockrand validate` share."""
import json
import shutil

from blockrand_run import SAMPLE, BuildTest, blockrand
from damage import Damaged


class Validated(BuildTest):
    def validate(self, folder, *options):
        run = blockrand('validate', folder, '--json', '--progress', 'none', *options, timeout=3600)
        self.assertIn(run.code, (0, 2), run)
        self.assertEqual(run.err, '', run)
        result = json.loads(run.out)
        self.assertEqual(run.code, 0 if result['sound'] else 2)
        self.assertEqual(result['sound'], not result['findings'])
        return result

    def sound(self, folder, *options):
        result = self.validate(folder, *options)
        said = '\n'.join(f"{f['code']} {f['file']} {f['object']}: {f['detail']}" for f in result['findings'][:30])
        self.assertTrue(result['sound'], said)
        return result


class Damages(Validated):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'out', '--formats', 'gltf,citygml,cityjson,gpkg', '--compress', 'none')
        cls.number = 0

    def damaged(self):
        type(self).number += 1
        return Damaged(self.out, self.path(f'damaged{self.number}'))

    def found(self, damage, codes, *words, options=(), seal=True):
        """Exactly these codes, and for each word a finding that has it in file, object or detail."""
        if seal:
            damage.seal()
        result = self.validate(damage.folder, *options)
        said = [f"{f['code']} {f['file']} {f['object']}: {f['detail']}" for f in result['findings']]
        shown = '\n'.join(said[:30])
        self.assertEqual(sorted({f['code'] for f in result['findings']}), sorted(codes.split()), shown)
        for word in words:
            self.assertTrue(any(word in line for line in said), f'{word} is named by none of\n{shown}')
        shutil.rmtree(damage.folder)
        return result

    def validate_sealed(self, d):
        d.seal()
        return self.validate(d.folder)
