"""Rule files from the command line: those that come with the program are clean and do what their tests say; models are valid."""
import glob
import os
import unittest

import validators
from blockrand_run import SOURCE, BuildTest, blockrand, main

GRAMMARS = os.path.join(SOURCE, 'configs', 'grammars')

# A roof with overhang, a court with holes, a turned tower, glass, and shapes of no volume.
HOUSE = '''
attr height = 6
Lot --> split(x){ ~1 : House | 4 : Tower } comp(fe){ all : s('1, '1, 0) Kerb. }
House --> color("#d8c9a8") shapeO(3, 3, 3, 3){ shape : extrude(height) comp(f){ top : Roof | side : Wall | bottom : NIL } | remainder : Yard. }
Roof --> color("#8a4b3a") roofHip(35, 0.4) comp(f){ bottom : NIL | all : Tiles. }
Wall --> split(x){ ~2 : split(y){ 1 : Plain. | 1.4 : color("#88aacc80") t(0, 0, -0.1) Glass. | ~1 : Plain. } | ~1 : Plain. }*
Tower --> r(scopeCenter, 0, 30, 0) extrude(9) Tower.
'''


class Grammar(BuildTest):
    def rules(self):
        files = sorted(glob.glob(os.path.join(GRAMMARS, '**', '*.cga'), recursive=True))
        self.assertGreater(len(files), 5)
        return files

    def test_those_that_come_with_the_program_are_clean(self):
        run = blockrand('grammar', 'check', '--roots', GRAMMARS, *self.rules())
        self.assertEqual(run.code, 0, run)
        self.assertIn('0 errors, 0 warnings', run.out)

    def test_their_expectations_hold(self):
        run = blockrand('grammar', 'test', '--roots', GRAMMARS, os.path.join(GRAMMARS, 'bilke', 'tenement_test.cga'))
        self.assertEqual(run.code, 0, run)
        self.assertNotIn('0 of 0', run.out)

    def test_a_model_is_valid_gltf(self):
        os.makedirs(self.path('models'))
        with open(self.path('house.cga'), 'w', encoding='utf-8') as f:
            f.write(HOUSE)
        for seed in range(3):
            run = blockrand('grammar', 'run', self.path('house.cga'), '--lot', '24x18', '--seed', str(seed),
                            '-o', self.path('models', f'{seed}.glb'))
            self.assertEqual(run.code, 0, run)
        self.assertEqual(validators.khronos(self.path('models')), '')


if __name__ == '__main__':
    main()
