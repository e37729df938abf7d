"""Which presets houses wear, extract by extract: preset_counts.py FOLDER… (of `build --formats geopackage`), as a Markdown table.

The last row is the share of the volume built that wears `plain`, walls without openings.
"""
import os
import sqlite3
import sys


def worn(folder):
    """Houses and volume by preset."""
    db = sqlite3.connect(os.path.join(folder, 'buildings.gpkg'))
    return {preset: (count, volume or 0) for preset, count, volume in db.execute(
        "select preset, count(*), sum(volume) from buildings where state != 'reported' group by preset")}


def main(folders):
    names = [os.path.basename(os.path.normpath(f)) for f in folders]
    tables = [worn(f) for f in folders]
    presets = sorted({p for t in tables for p in t}, key=lambda p: -sum(t.get(p, (0, 0))[0] for t in tables))
    print('| preset | ' + ' | '.join(names) + ' |')
    print('|---|' + '---:|' * len(names))
    for preset in presets:
        print(f'| `{preset}` | ' + ' | '.join(str(t.get(preset, (0, 0))[0] or '') for t in tables) + ' |')
    shares = [100 * t.get('plain', (0, 0))[1] / max(1, sum(v for _, v in t.values())) for t in tables]
    print('| volume of `plain`, % | ' + ' | '.join(f'{s:.2f}' for s in shares) + ' |')


if __name__ == '__main__':
    main(sys.argv[1:])
