"""`blockrand compare` for tests: running it, reading what it wrote, setting results side by side."""
import os

from blockrand_run import BuildTest, Setup, blockrand, read_json, stray_siblings

FILES = ['compare.csv', 'compare.gpkg', 'compare.html', 'compare.json']


def reference(*names):
    """Path of a hand-built model, or None where the shared data is absent."""
    path = os.path.join(Setup.shared or '', 'data', 'reference', *names)
    return path if os.path.exists(path) else None


def headline(comparison, measure, part='counted'):
    """What a measure is over all matches: its size where it has a sign, else what it was pooled to. None: no value."""
    summary = comparison['summary'][measure]
    return summary[part]['mean_abs' if summary['better'] == 'zero' else 'pooled']


def distance_from_ideal(comparison, measure, value):
    """0 is ideal; larger is worse. Ratios alike for twice and half."""
    better = comparison['summary'][measure]['better']
    if better == 'higher':
        return 1 - value
    return max(value, 1e-6, 1 / max(value, 1e-6)) - 1 if better == 'one' else abs(value)


def table(title, comparisons, but=()):
    """Prints every measure that has a value in one of {name: comparison}, counted / all, and what was left out."""
    first = next(iter(comparisons.values()))
    print(f'\n{title} (counted / all)')
    print(f'{"":22}' + ''.join(f'{name:>23}' for name in comparisons) + '   left out')
    for measure, summary in first['summary'].items():
        cells = []
        for comparison in comparisons.values():
            values = [headline(comparison, measure, part) for part in ('counted', 'all')]
            cells.append(' / '.join('-' if v is None else f'{v:.4g}' for v in values))
        if measure not in but and any(c != '- / -' for c in cells):
            print(f'{measure:22}' + ''.join(f'{c:>23}' for c in cells) + f'{summary["left_out"]:>10.1%}')
    for what in ('matches', 'missing', 'extra'):
        print(f'{what:22}' + ''.join(f'{c["counts"][what]:>23}' for c in comparisons.values()), flush=True)


def verdict(text):
    """{measure: line} of what --baseline printed as worse."""
    return {line.split()[0]: line for line in text.splitlines() if line.endswith('  WORSE')}


class CompareTest(BuildTest):
    def compare(self, name, model, *references_and_options, code=0):
        """A comparison that must end with `code` and write everything. Returns its compare.json."""
        target = self.path(name)
        options = [] if '--pictures' in references_and_options else ['--pictures', 0]
        run = blockrand('compare', model, *references_and_options, '-o', target, '--progress', 'none', *options)
        type(self).last = run
        self.assertEqual(run.code, code, run)
        self.assertEqual(sorted(os.listdir(target)), FILES, run)
        self.assertEqual(stray_siblings(target), [], run)
        return read_json(target, 'compare.json')

    def ideal(self, comparison, tolerance, but=()):
        """Every measure that judges has its ideal value in every match, counted and all."""
        for match in comparison['matches']:
            for measure, value in match['measures'].items():
                better = comparison['summary'][measure]['better']
                if better == 'none' or measure in but:
                    continue
                for part in ('counted', 'all'):
                    if value[part] is not None:
                        away = distance_from_ideal(comparison, measure, value[part])
                        self.assertLessEqual(away, tolerance, f'{match["id"]}: {measure} {part} {value[part]}')

    def same(self, a, b, measure, tolerance):
        """Within a tolerance in the measure's unit, counted and all."""
        for part in ('counted', 'all'):
            first, second = headline(a, measure, part), headline(b, measure, part)
            self.assertEqual(first is None, second is None, f'{measure}, {part}: {first}, {second}')
            if first is not None:
                self.assertLessEqual(abs(first - second), tolerance, f'{measure}, {part}: {first}, {second}')
