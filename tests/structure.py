#!/usr/bin/python3
"""Counts how easily the code is seen and changed, by stated rules, on any tree of this repository.

    python3 tests/structure.py [TREE] [--build DIR] [--jobs N] [--cache DIR] [--check]

TREE is the root of a configured clone (else this one), DIR the build folder with its compile_commands.json (else
TREE/build/release; nothing needs to be compiled). Clang's own syntax tree is counted, not text: package python3-clang
(14 or newer). The first run takes a CPU second per source; what was counted is kept in --cache (else in the folder for
temporary files) by the hash of all that a source includes. Product code is what lies below pipeline, importers and
styles. A folder is one of the second level: pipeline/context, styles/roofs; deeper ones belong to it.

The rules:

hops        How often control enters another folder while a mapped footprint becomes output. The walk starts in the
            function `build` that returns a BuildSummary; its folder is the orchestrator (pipeline/region, later
            pipeline/run). Calls are taken in the order of the source text, those in lambdas where the lambda stands.
            The walk goes into the orchestrator's own functions, into each once, at its first call. A call counts when
            its function is declared in a header, defined in a source file, and is no member of a class (a member only
            where it is virtual: an interface). What knows no stage is no station: base, model, geometry, georef,
            settings. A hop is a counted call whose folder is another than that of the counted call before; coming back
            from a call is no hop by itself. The way begins with the first entry into importers/osm and ends with the
            first function of the outputs (pipeline/export, pipeline/outputs) whose name begins with `write` or that is
            virtual; without one, with the last entry into the outputs.
            A second figure, without a bound, goes one step deeper: into each function, whatever its folder, that the
            orchestrator calls.
functions   Longer than 120 lines, from the first line of the signature to the closing brace. A lambda is a part of the
            function it stands in.
files       Longer than 600 lines, but for tables: files more than 60 % of whose lines lie in braced lists of initialisers.
defaults    `default:` of a switch of which a label names an enumerator of an enum of ours.
positions   A braced list that sets a member of a struct of ours with more than 6 members (fields; those of bases are
            not counted) without its name; each line with such a list counts once. `Name{}` sets none; a call of a
            constructor is none.
roof shapes Files that someone who adds a roof shape has to look at: those with a switch over RoofShape, or with a braced
            list of 3 or more of its enumerators.

Exit code 0; with --check 1 where a bound of "Done means" of the issue that asked for it is exceeded: 22 hops, no function,
no file, no default, no position, 5 files of roof shapes. With --check 77 where nothing can be counted.
"""
import argparse
import collections
import hashlib
import inspect
import json
import multiprocessing
import os
import re
import shlex
import sys
import tempfile

TOPS = ('pipeline', 'importers', 'styles')
TOOLS = {'pipeline/base', 'pipeline/model', 'pipeline/geometry', 'pipeline/georef', 'pipeline/settings'}
READING = 'importers/osm'
OUTPUTS = {'pipeline/export', 'pipeline/outputs'}
MOST_HOPS, MOST_LINES, MOST_FILE_LINES, TABLE_SHARE, MOST_MEMBERS, MOST_ROOF_FILES = 22, 120, 600, 0.6, 6, 5
ROOF_SHAPE = 'RoofShape'
LISTED_SHAPES = 3

try:
    sys.path.append('/usr/lib/python3/dist-packages')  # Debian's place, for a python3 from elsewhere
    from clang import cindex
    from clang.cindex import CursorKind
except ImportError:
    cindex = None


def folder_of(path):
    return '/'.join(path.split('/')[:2])


# ------------------------------------------------------------------------------------------------ what one source says

class Source:
    """The facts of one source and of the headers that are counted with it."""

    def __init__(self, tree, path, headers):
        self.tree, self.mine, self.relative = tree, {path, *headers}, {}
        self.facts = {'errors': [], 'functions': [], 'switches': [], 'positions': [], 'lists': [], 'shapes': []}

    def place(self, location):
        """Path below the tree of what is ours, else None. Includes go through a farm of links in the build folder."""
        if location.file is None:
            return None
        name = location.file.name
        if name not in self.relative:
            path = os.path.relpath(os.path.realpath(name), self.tree)
            self.relative[name] = path if path.split('/')[0] in TOPS else None
        return self.relative[name]

    def read(self, command):
        arguments, words = [], command['arguments']
        for i, word in enumerate(words):
            if word.startswith(('-D', '-I', '-std')):
                arguments.append(word)
            elif word == '-isystem':
                arguments += [word, words[i + 1]]
        os.chdir(command['directory'])
        unit = cindex.Index.create().parse(command['file'], args=arguments)
        self.facts['errors'] = [str(d) for d in unit.diagnostics if d.severity >= cindex.Diagnostic.Error]
        for cursor in unit.cursor.get_children():
            if self.place(cursor.location) in self.mine:
                self.visit(cursor, None, None)
        return self.facts

    def visit(self, cursor, function, within):
        """within: 'case' in a label, a number in a braced list: that of the outermost one."""
        kind = cursor.kind
        if kind in FUNCTIONS and cursor.is_definition():
            function = {'file': self.place(cursor.location), 'name': qualified(cursor), 'usr': cursor.get_usr(),
                        'from': cursor.extent.start.line, 'to': cursor.extent.end.line, 'calls': [],
                        'returns': cursor.result_type.spelling}
            self.facts['functions'].append(function)
        elif kind == CursorKind.CALL_EXPR and function is not None:
            self.call(cursor, function)
        elif kind == CursorKind.SWITCH_STMT:
            self.switch(cursor)
        elif kind == CursorKind.INIT_LIST_EXPR:
            if not isinstance(within, int):
                within = len(self.facts['lists'])
                self.facts['lists'].append([self.place(cursor.location), cursor.extent.start.line, cursor.extent.end.line])
            self.position(cursor)
        elif kind == CursorKind.COMPOUND_STMT:
            within = None
        elif kind == CursorKind.DECL_REF_EXPR:
            named = cursor.referenced
            if within is not None and named is not None and named.kind == CursorKind.ENUM_CONSTANT_DECL and \
                    named.semantic_parent.spelling == ROOF_SHAPE:
                self.facts['shapes'].append([self.place(cursor.location), cursor.location.line, within])
        children = list(cursor.get_children())
        if kind == CursorKind.CASE_STMT and children:
            self.visit(children.pop(0), function, 'case')
            within = None
        for child in children:
            self.visit(child, function, within)

    def call(self, cursor, function):
        named = cursor.referenced
        if named is None or named.kind not in FUNCTIONS:
            return
        declared = self.place(named.canonical.location)
        if declared is None:
            return
        template = cindex.conf.lib.clang_getSpecializedCursorTemplate(named)
        usr = template.get_usr() if template is not None and template.kind in FUNCTIONS else named.get_usr()
        member = named.kind not in (CursorKind.FUNCTION_DECL, CursorKind.FUNCTION_TEMPLATE) or \
            named.semantic_parent.kind in (CursorKind.CLASS_DECL, CursorKind.STRUCT_DECL, CursorKind.CLASS_TEMPLATE)
        virtual = named.kind == CursorKind.CXX_METHOD and named.is_virtual_method()
        function['calls'].append([cursor.location.line, cursor.location.column, usr, qualified(named), declared, member, virtual])

    def switch(self, cursor):
        labels, defaults = set(), []

        def enum_of(label):
            named = label.referenced if label.kind == CursorKind.DECL_REF_EXPR else None
            if named is not None and named.kind == CursorKind.ENUM_CONSTANT_DECL:
                return qualified(named.semantic_parent) if self.place(named.location) else None
            return next((e for e in map(enum_of, label.get_children()) if e), None)

        def scan(node):
            for child in node.get_children():
                if child.kind == CursorKind.SWITCH_STMT:
                    continue
                if child.kind == CursorKind.CASE_STMT:
                    labels.add(enum_of(next(child.get_children())))
                elif child.kind == CursorKind.DEFAULT_STMT:
                    defaults.append(child.location.line)
                scan(child)

        scan(cursor)
        if labels - {None}:
            self.facts['switches'].append([self.place(cursor.location), cursor.location.line, min(labels - {None}), defaults])

    def position(self, cursor):
        type_ = cursor.type.get_canonical()
        record = type_.get_declaration()
        if record.kind not in (CursorKind.STRUCT_DECL, CursorKind.CLASS_DECL) or not self.place(record.location):
            return
        members = sum(1 for _ in type_.get_fields())
        set_ = sum(1 for _ in cursor.get_children())
        if members <= MOST_MEMBERS or set_ == 0:
            return
        tokens = [t.spelling for _, t in zip(range(2), cursor.get_tokens())]
        if tokens[1:] != ['.']:
            self.facts['positions'].append([self.place(cursor.location), cursor.location.line, qualified(record), members, set_])


def qualified(cursor):
    names = []
    while cursor is not None and cursor.kind != CursorKind.TRANSLATION_UNIT:
        if cursor.spelling:
            names.append(cursor.spelling)
        cursor = cursor.semantic_parent
    return '::'.join(reversed(names))


if cindex:
    FUNCTIONS = {CursorKind.FUNCTION_DECL, CursorKind.CXX_METHOD, CursorKind.CONSTRUCTOR, CursorKind.DESTRUCTOR,
                 CursorKind.FUNCTION_TEMPLATE, CursorKind.CONVERSION_FUNCTION}


def read_source(job):
    sys.setrecursionlimit(100000)
    tree, path, headers, command, kept = job
    if os.path.exists(kept):
        with open(kept, encoding='utf-8') as f:
            return path, json.load(f)
    facts = Source(tree, path, headers).read(command)
    with open(kept + f'.{os.getpid()}', 'w', encoding='utf-8') as f:
        json.dump(facts, f)
    os.replace(kept + f'.{os.getpid()}', kept)
    return path, facts


# ------------------------------------------------------------------------------------------------------------ the tree

def product_files(tree):
    found = []
    for top in TOPS:
        for folder, folders, names in os.walk(os.path.join(tree, top)):
            folders.sort()
            found += [os.path.relpath(os.path.join(folder, n), tree) for n in names if n.endswith(('.cpp', '.h'))]
    return sorted(found)


def commands_of(build):
    """By the real path of each source; those in unity sources by what these include."""
    with open(os.path.join(build, 'compile_commands.json'), encoding='utf-8') as f:
        rows = json.load(f)
    out = {}
    for row in rows:
        words = row.get('arguments') or shlex.split(row['command'])
        name = os.path.realpath(os.path.join(row['directory'], row['file']))
        sources = [name]
        if '/Unity/' in name and os.path.exists(name):
            with open(name, encoding='utf-8') as f:
                sources = [os.path.realpath(os.path.join(os.path.dirname(name), s))
                           for s in re.findall(r'^#include "([^"]+)"', f.read(), re.M)]
        for source in sources:
            out[source] = {'directory': row['directory'], 'file': source, 'arguments': words}
    return out


def jobs_of(tree, commands, cache):
    files = product_files(tree)
    text = {}
    for path in files:
        with open(os.path.join(tree, path), encoding='utf-8') as f:
            text[path] = f.read()
    digest = {path: hashlib.sha256(t.encode()).hexdigest() for path, t in text.items()}
    includes = {path: [i for i in re.findall(r'^#include "([^"]+)"', t, re.M) if i in text] for path, t in text.items()}

    def reached(path):
        seen, open_ = {path}, [path]
        while open_:
            for i in includes[open_.pop()]:
                if i not in seen:
                    seen.add(i)
                    open_.append(i)
        return seen

    sources = [p for p in files if p.endswith('.cpp') and os.path.join(tree, p) in commands]
    reach = {p: reached(p) for p in sources}
    # A header is counted with the source of its name, else with the first that includes it.
    counted_with = {}
    for header in (p for p in files if p.endswith('.h')):
        own = header[:-2] + '.cpp'
        users = [own] if own in reach else [p for p in sources if header in reach[p]]
        if users:
            counted_with.setdefault(users[0], []).append(header)
    how = inspect.getsource(Source) + inspect.getsource(qualified)
    jobs = []
    for path in sources:
        command = commands[os.path.join(tree, path)]
        headers = counted_with.get(path, [])
        flags = [a.replace(tree, '') for a in command['arguments'] if a.startswith(('-D', '-std'))]
        key = json.dumps([how, cindex.__file__, path, headers, flags, sorted((p, digest[p]) for p in reach[path])])
        jobs.append((tree, path, headers, command, os.path.join(cache, hashlib.sha256(key.encode()).hexdigest() + '.json')))
    lines = {path: t.count('\n') for path, t in text.items()}
    return jobs, lines, [p for p in files if p.endswith('.cpp') and p not in reach]


# ---------------------------------------------------------------------------------------------------------- the counts

def way_of_a_footprint(functions, deeper):
    """[(folder, function)] of the stations, the orchestrator first; empty where there is none."""
    builds = [f for f in functions.values() if f['name'].endswith('::build') and 'BuildSummary' in f['returns']]
    if not builds:
        return []
    orchestrator = folder_of(builds[0]['file'])
    calls, gone = [(orchestrator, builds[0]['name'], False)], {builds[0]['usr']}

    def walk(function, depth):
        for _, _, usr, name, declared, member, virtual in sorted(function['calls'], key=lambda c: (c[0], c[1])):
            callee = functions.get(usr)
            if folder_of(callee['file'] if callee and not virtual else declared) in TOOLS:
                continue
            if virtual:
                calls.append((folder_of(declared), name, True))
                continue
            if callee is None:
                continue
            folder, own = folder_of(callee['file']), declared.endswith('.cpp')
            if not own and not member and callee['file'].endswith('.cpp'):
                calls.append((folder, name, False))
            step = 0 if folder == orchestrator else depth + (0 if own else 1)
            if usr not in gone and (folder == orchestrator or deeper and step <= 1):
                gone.add(usr)
                walk(callee, step)

    walk(builds[0], 0)
    stations = [c for i, c in enumerate(calls) if i == 0 or c[0] != calls[i - 1][0]]
    first = next((i for i, s in enumerate(stations) if s[0] == READING), 1)
    # A stretch of calls into one folder is one station: the end is looked for in all calls.
    begun, end = False, None
    for i, (folder, name, virtual) in enumerate(calls):
        begun = begun or folder == READING
        if begun and folder in OUTPUTS and (virtual or name.split('::')[-1].startswith('write')):
            end = sum(1 for k in range(1, i + 1) if calls[k][0] != calls[k - 1][0])
            break
    if end is None:
        end = max((i for i, s in enumerate(stations) if s[0] in OUTPUTS), default=len(stations) - 1)
    return [(folder, name) for folder, name, _ in stations[first - 1:end + 1]]


def count(tree, facts, lines):
    functions, switches, positions, lists, shapes = {}, {}, {}, collections.defaultdict(set), []
    for path, f in sorted(facts.items()):
        for function in f['functions']:
            functions.setdefault(function['usr'], function)
        for file, line, enum, defaults in f['switches']:
            switches[file, line] = enum, defaults
        for file, line, *what in f['positions']:
            positions.setdefault((file, line), what)
        for file, start, end in f['lists']:
            lists[file].update(range(start, end + 1))
        shapes += [(file, line, within if within == 'case' else f'{path}:{within}') for file, line, within in f['shapes']]
    long_files = {p: len(lists[p]) / n for p, n in lines.items() if n > MOST_FILE_LINES}
    roof_switches = collections.Counter(file for (file, _), (enum, _) in switches.items() if enum.split('::')[-1] == ROOF_SHAPE)
    in_lists = collections.Counter((file, within) for file, _, within in set(shapes) if within != 'case')
    named = collections.Counter()
    for file, _, within in shapes:
        if within != 'case':
            named[file, within] += 1
    roof_lists = {file for (file, within), n in named.items() if n >= LISTED_SHAPES and in_lists[file, within]}
    return {
        'ways': [way_of_a_footprint(functions, deeper) for deeper in (False, True)],
        'functions': sorted(((f['to'] - f['from'] + 1, f['file'], f['name']) for f in functions.values()
                             if f['to'] - f['from'] + 1 > MOST_LINES), reverse=True),
        'all_functions': len(functions),
        'files': sorted((lines[p], p) for p, share in long_files.items() if share <= TABLE_SHARE)[::-1],
        'tables': sorted((lines[p], p, share) for p, share in long_files.items() if share > TABLE_SHARE)[::-1],
        'shares': long_files,
        'defaults': sorted((file, line, enum) for (file, _), (enum, defaults) in switches.items() for line in defaults),
        'switches': len(switches),
        'positions': sorted((file, line, *what) for (file, line), what in positions.items()),
        'roof_switches': roof_switches,
        'roof_lists': roof_lists,
    }


def print_counts(c):
    """Prints all; returns the bounds that are exceeded."""
    exceeded = []

    def head(title, number, bound):
        print(f'\n{title}: {number}' + (f' (at most {bound})' if bound is not None else ''))
        if bound is not None and number > bound:
            exceeded.append(f'{title}: {number}, at most {bound}')

    for way, title, bound in zip(c['ways'], ('hops from footprint to export', 'hops, one step deeper'), (MOST_HOPS, None)):
        head(title, max(len(way) - 1, 0), bound)
        if not way:
            exceeded.append(f'{title}: no function build that returns a BuildSummary')
            continue
        entered = collections.Counter(folder for folder, _ in way)
        print('  entered: ' + ', '.join(f'{folder} {n}' for folder, n in entered.most_common()))
        print('  ' + ' > '.join(f'{folder.split("/")[-1]}:{name.split("::")[-1]}' for folder, name in way))
    head(f'functions of more than {MOST_LINES} lines', len(c['functions']), 0)
    print(f'  of {c["all_functions"]}')
    for n, file, name in c['functions']:
        print(f'  {n:5} {file} {name}')
    head(f'files of more than {MOST_FILE_LINES} lines that are no tables', len(c['files']), 0)
    for n, file in c['files']:
        print(f'  {n:5} {file}, {c["shares"][file]:.0%} in lists of initialisers')
    for n, file, share in c['tables']:
        print(f'  {n:5} {file}: a table, {share:.0%} in lists of initialisers')
    head('default: in switches over enums of ours', len(c['defaults']), 0)
    print(f'  {c["switches"]} switches over such enums')
    for file, line, enum in c['defaults']:
        print(f'  {file}:{line} {enum}')
    head(f'members set by position, of structs with more than {MOST_MEMBERS}', len(c['positions']), 0)
    for file, line, record, members, set_ in c['positions']:
        print(f'  {file}:{line} {record}: {set_} of {members} members')
    roof_files = sorted(set(c['roof_switches']) | c['roof_lists'])
    head('files to look at for a new roof shape', len(roof_files), MOST_ROOF_FILES)
    print(f'  {sum(c["roof_switches"].values())} switches over {ROOF_SHAPE} in {len(c["roof_switches"])} files')
    for file in roof_files:
        print(f'  {file}: {c["roof_switches"].get(file, 0)} switches' + (', a list' if file in c['roof_lists'] else ''))
    return exceeded


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('tree', nargs='?', default=os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    parser.add_argument('--build')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('--cache', default=os.path.join(tempfile.gettempdir(), f'blockrand-structure-{os.getuid()}'))
    parser.add_argument('--check', action='store_true')
    options = parser.parse_args()
    tree = os.path.realpath(options.tree)
    build = options.build or os.path.join(tree, 'build', 'release')
    missing = None
    if cindex is None:
        missing = 'no clang for Python: apt install python3-clang'
    elif not os.path.exists(os.path.join(build, 'compile_commands.json')):
        missing = f'no compile_commands.json in {build}: configure with cmake --preset release'
    if missing:
        print(f'structure: nothing counted: {missing}')
        sys.exit(77 if options.check else 0)
    os.makedirs(options.cache, exist_ok=True)
    os.nice(10)
    jobs, lines, left = jobs_of(tree, commands_of(build), options.cache)
    with multiprocessing.Pool(options.jobs) as pool:
        facts = dict(pool.imap_unordered(read_source, jobs, chunksize=4))
    print(f'{tree}: {len(jobs)} sources, {len(lines)} files, {sum(lines.values()):,} lines of product code')
    for path in left:
        print(f'  not compiled, functions not counted: {path}')
    for path, f in sorted(facts.items()):
        for error in f['errors'][:2]:
            print(f'  clang does not understand {path}: {error}')
    exceeded = print_counts(count(tree, facts, lines))
    print('\n' + ('exceeded:\n  ' + '\n  '.join(exceeded) if exceeded else 'all bounds are kept'))
    sys.exit(1 if options.check and exceeded else 0)


if __name__ == '__main__':
    main()
