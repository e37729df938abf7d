#!/usr/bin/python3
"""Finds out which sources can be compiled as one, and writes cmake/compiled_together.cmake.

    cmake -S . -B build/apart -G Ninja -DCMAKE_BUILD_TYPE=Release -DBLOCKRAND_TOGETHER=OFF -DBLOCKRAND_TESTS=OFF
    python3 cmake/compiled_together.py build/apart
    python3 cmake/compiled_together.py --check       # a test: that no group of the list has such names

Most of a first build reads and instantiates the same templates once for each source; sources that are compiled as one do
it once. Sources of a target go together where none hides a name of another: names in anonymous namespaces, `static`
functions, macros and `using namespace` are compared first, then the compiler is asked. The compiler does not see all: a
function that one source has for itself may suit a call in another better than the function that is meant. So no source
goes with one that calls anything by a name that it hides. A source that goes with no other
is compiled alone, as every source is that the list does not name: who adds a file needs not touch the list, who adds a
name that another file of the group has takes the file out of it, or renames. The list is made anew once in a while.
"""
import argparse
import concurrent.futures
import json
import os
import random
import re
import shlex
import subprocess
import sys
import tempfile

MOST_FILES, MOST_LINES = 16, 3600  # of a group: one change compiles all of it again
TRIES = 300  # orders of the sources; the one with the fewest groups is taken
HEAVY = re.compile(r'#include <CGAL/|#include "pipeline/geometry/cgal')  # memory and time enough by themselves
HEADER = '''# Made by cmake/compiled_together.py, which says how and why: sources that are compiled as one, by target. A source that
# stands nowhere is compiled alone. Does a name of yours collide with one of another source? Take yours out.
'''


def hidden_names(text):
    """Names that a source declares for itself alone, and a word for what must not be shared at all."""
    names = set()
    for match in re.finditer(r'^\s*#define (\w+)', text, re.M):
        names.add('#' + match.group(1))
    if re.search(r'^using namespace ', text, re.M):
        names.add('using namespace')
    inside = False
    for line in text.split('\n'):
        if re.match(r'namespace( \w+)* \{$', line) and not re.match(r'namespace \w', line):
            inside = True
        elif re.match(r'\}  // namespace$', line):
            inside = False
        if line.startswith((' ', '/', '}', '#')) or not (inside or line.startswith('static ')):
            continue
        kind = re.match(r'(?:struct|class|enum class|enum|union) (\w+)', line)
        alias = re.match(r'(?:using (\w+) =|namespace (\w+) =|using [\w:]+::([a-z_]\w*);)', line)
        value = re.match(r'(?:static |inline )*(?:constexpr|const) [^=({]*?\b(\w+)(?:\[[^\]]*\])*(?: = | ?\{)', line)
        function = re.match(r'[\w:<>,&*\s\[\]()]*?\b(\w+)\(', line)
        for match in (kind, alias, value, function):
            if match:
                names.add(next(g for g in match.groups() if g))
                break
    return names


def called_names(text):
    """Functions that a source calls without naming their class or namespace."""
    return set(re.findall(r'(?<![\w.:>])([A-Za-z_]\w*)\(', re.sub(r'//.*', '', text)))


class Target:
    def __init__(self, name):
        self.name, self.sources = name, []


def read_targets(build):
    targets = {}
    for entry in json.load(open(os.path.join(build, 'compile_commands.json'))):
        match = re.search(r'-o \S*CMakeFiles/blockrand_(\w+)\.dir/', entry['command'])
        if not match or '_headers' in match.group(1) or '/tests/' in entry['file'] or entry['file'].startswith(build):
            continue
        targets.setdefault(match.group(1), Target(match.group(1))).sources.append(entry)
    return targets


def flags(entry):
    words = shlex.split(entry['command'])
    words = words[next(i for i, w in enumerate(words) if re.search(r'(\+\+|cc|clang)(-\d+)?$', w)):]
    out, skip = [], False
    for word in words:
        if skip:
            skip = False
        elif word in ('-o', '-MF', '-MT'):
            skip = True
        elif word not in ('-c', '-MD', entry['file']):
            out.append(word)
    return out


def compiles(entry, files):
    """Whether the files go as one. Templates are instantiated too: some collisions show there."""
    with tempfile.NamedTemporaryFile('w', suffix='.cxx', delete=False) as unit:
        unit.write(''.join(f'#include "{f}"\n' for f in files))
    try:
        result = subprocess.run(flags(entry) + ['-fsyntax-only', unit.name], cwd=entry['directory'], capture_output=True)
        return result.returncode == 0
    finally:
        os.unlink(unit.name)


def packed(sources):
    """Each of (file, lines, names, calls) goes to the first group that has room and none of its names."""
    groups = []
    for file, lines, names, calls in sources:
        for group in groups:
            apart = names & (group['names'] | group['calls']) or calls & group['names']
            if len(group['files']) < MOST_FILES and group['lines'] + lines <= MOST_LINES and not apart:
                break
        else:
            group = {'files': [], 'names': set(), 'calls': set(), 'lines': 0}
            groups.append(group)
        group['files'].append(file)
        group['names'] |= names
        group['calls'] |= calls
        group['lines'] += lines
    return groups


def fewest_groups(sources):
    orders = random.Random(len(sources))
    best = packed(sources)
    for _ in range(TRIES):
        best = min(best, packed(orders.sample(sources, len(sources))), key=len)
    return best


def groups_of(target):
    """Packs by names, then lets the compiler decide: what breaks a group is compiled alone."""
    by_flags = {}
    for entry in target.sources:
        by_flags.setdefault(tuple(flags(entry)), []).append(entry)
    out = []
    for entries in by_flags.values():
        order, sources = [e['file'] for e in entries], []
        for entry in entries:
            text = open(entry['file']).read()
            names = hidden_names(text)
            if not HEAVY.search(text) and 'using namespace' not in names:
                sources.append((entry['file'], text.count('\n'), names, called_names(text)))
        while len(sources) > 1:
            refused = []  # by the compiler: they get another chance among themselves
            for group in fewest_groups(sources):
                files = sorted(group['files'], key=order.index)  # as CMake will have them
                if len(files) > 1 and not compiles(entries[0], files):
                    good = files[:1]
                    for file in files[1:]:
                        if compiles(entries[0], good + [file]):
                            good.append(file)
                    refused += [f for f in files if f not in good]
                    files = good
                if len(files) > 1:
                    out.append(files)
            sources = [s for s in sources if s[0] in refused]
    return out


def check(root):
    """Groups of the list, one of whose sources hides a name that another has or calls; how many."""
    with open(os.path.join(root, 'cmake', 'compiled_together.cmake')) as file:
        groups = re.findall(r'^blockrand_compile_together\(\w+  # (\S+)\n([^)]*)\)', file.read(), re.M)
    wrong = 0
    for folder, files in groups:
        sources = {f: open(os.path.join(root, folder, f)).read() for f in files.split()}
        hidden = {f: hidden_names(text) for f, text in sources.items()}
        called = {f: called_names(text) for f, text in sources.items()}
        for a in sources:
            for b in sources:
                common = hidden[a] & (hidden[b] | called[b]) if a != b else set()
                if 'using namespace' in hidden[a] and a != b:
                    common.add('using namespace')
                if common:
                    wrong += 1
                    print(f'{folder}: {a} has {", ".join(sorted(common))} for itself, which {b} uses as well: rename it, '
                          f'or take one of the two out of cmake/compiled_together.cmake')
    print(f'{len(groups)} groups, {wrong} collisions')
    return 1 if wrong or not groups else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--check', action='store_true')
    parser.add_argument('build', nargs='?', help='configured with -DBLOCKRAND_TOGETHER=OFF')
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--target', help='prints the groups of one target and writes nothing')
    args = parser.parse_args()
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    if args.check:
        sys.exit(check(root))
    if not args.build:
        parser.error('a build folder, or --check')
    targets = [t for t in read_targets(os.path.abspath(args.build)).values() if args.target in (None, t.name)]
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        found = list(pool.map(groups_of, targets))
    text, together, alone = HEADER, 0, 0
    for target, groups in zip(targets, found):
        folder = os.path.commonpath([os.path.dirname(e['file']) for e in target.sources])
        together += sum(map(len, groups))
        alone += len(target.sources) - sum(map(len, groups))
        for group in groups:
            text += f'blockrand_compile_together({target.name}  # {os.path.relpath(folder, root)}\n'
            line = ' '
            for name in (os.path.relpath(f, folder) for f in group):
                if len(line) + 1 + len(name) > 120:
                    text += line + '\n'
                    line = ' '
                line += ' ' + name
            text += line + ')\n'
    if args.target:
        print(text)
    else:
        with open(os.path.join(root, 'cmake', 'compiled_together.cmake'), 'w') as file:
            file.write(text)
    print(f'{together} sources in {sum(map(len, found))} groups, {alone} alone', file=sys.stderr)


if __name__ == '__main__':
    main()
