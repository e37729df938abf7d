#!/usr/bin/env python3
"""Lists product functions that main() cannot reach, and compares them with an allowlist.

    unreachable.py PROGRAM [ALLOWLIST]

PROGRAM holds all product objects, those that nothing refers to as well (whole archives). The call graph is read from its
machine code: calls, jumps and addresses taken in code, and addresses in data that reached code refers to. Templates and
inline functions (weak symbols), functions of one file (local symbols), constructors, destructors and assignments are not
listed: the ones that only tests call hang on a listed one. A function that its callers took in (inlined) leaves no call
behind: a function is listed only when no source of its folder calls it either, since any of them may be compiled as one
with it. Sources are searched for its bare name: a dead function that calls itself, or whose namesake is called in its
folder, is missed.
Ends with 1 when a function is missing from the allowlist, when an entry of the list is reached or gone, or when a row of
docs/internal/seeds.md is done by a test that calls a listed function (allowed or not); and with 77 (skipped) for programs of other processors than x86-64. unreachable_test.py proves it.
"""
import bisect
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INSTRUCTION = re.compile(r"^\s+[0-9a-f]+:\s.*?(?:\b(?:call|jmp|j[a-z]+)\s+([0-9a-f]+) <|# ([0-9a-f]+) <)")
FUNCTION = re.compile(r"^([0-9a-f]+) <(.+)>:$")
CODE, DATA = "tTwW", "dDrRbBvVu"


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Symbols:
    """Symbols of a program by address."""

    def __init__(self, program):
        self.at = {}
        for line in output("nm", "-S", "--defined-only", program).splitlines():
            word = line.split()
            if len(word) == 4:
                start, size, kind, name = int(word[0], 16), int(word[1], 16), word[2], word[3]
                if start not in self.at or kind.isupper():
                    self.at[start] = (size, kind, name)
        self.starts = sorted(self.at)

    def holding(self, address):
        i = bisect.bisect_right(self.starts, address) - 1
        if i < 0 or address >= self.starts[i] + max(1, self.at[self.starts[i]][0]):
            return None
        return self.starts[i]


def references(program, symbols):
    """start of a symbol -> starts of those it refers to; and the targets of data that bears no name."""
    refers, nameless = collections.defaultdict(set), set()
    with subprocess.Popen(["objdump", "-d", "--no-show-raw-insn", program], stdout=subprocess.PIPE, text=True) as code:
        here = None
        for line in code.stdout:
            if line[0] == " ":
                found = INSTRUCTION.match(line)
                if found:
                    target = symbols.holding(int(found.group(1) or found.group(2), 16))
                    if target is not None and target != here:
                        refers[here].add(target)
            else:
                begins = FUNCTION.match(line)
                if begins:
                    here = symbols.holding(int(begins.group(1), 16))
    for line in output("readelf", "-rW", program).splitlines():
        word = line.split()
        if len(word) == 4 and word[2] == "R_X86_64_RELATIVE":
            target = symbols.holding(int(word[3], 16))
            if target is None:
                continue
            holder = symbols.holding(int(word[0], 16))
            if holder is None:
                nameless.add(target)
            else:
                refers[holder].add(target)
    return refers, nameless


def reached(symbols, refers, nameless):
    todo = [a for a, (_, _, name) in symbols.at.items() if name in ("main", "_start")] + list(nameless)
    # Start-up code of a file.
    todo += [a for a, (_, _, name) in symbols.at.items() if name.startswith("_GLOBAL__sub_I")]
    seen = set()
    while todo:
        address = todo.pop()
        if address not in seen:
            seen.add(address)
            todo += refers[address]
    return seen


def short_name(name):
    """blockrand::a::B::f[abi:cxx11](int) -> f; the tag says that a std::string is returned."""
    return re.sub(r"(\[abi:\w+\])?\(.*", "", name.replace("(anonymous namespace)::", "")).split("::")[-1]


def called_in_its_source(name, sources):
    """Does the file that defines the function name it a second time, apart from comments?"""
    short = short_name(name)
    word = re.compile(r"(?<![\w\"])" + re.escape(short) + r"\s*\(")
    definition = re.compile(r"^[\w:<>,&*\s\[\]]*?\b" + re.escape(short) + r"\(.*", re.M)
    for text in sources:
        if definition.search(text) and len(word.findall(text)) > 1:
            return True
    return False


def product_sources():
    """Their texts; those of a folder of the second level as one text besides: any of them may be compiled as one."""
    texts, folders = [], collections.defaultdict(list)
    for top in ("pipeline", "importers", "styles"):
        for path in sorted((ROOT / top).rglob("*.cpp")):
            texts.append(re.sub(r"//.*", "", path.read_text(encoding="utf-8")))
            folders[path.relative_to(ROOT).parts[:2]].append(texts[-1])
    return texts + ["\n".join(parts) for parts in folders.values()]


def unreachable(program, sources):
    symbols = Symbols(program)
    refers, nameless = references(program, symbols)
    seen = reached(symbols, refers, nameless)
    left = [name for address, (_, kind, name) in symbols.at.items()
            if kind == "T" and address not in seen and name.startswith("_ZN") and "9blockrand" in name[:16]
            and not re.search(r"[CD][0123]E|aSEOS_$|aSERKS_$", name)]
    names = subprocess.run(["c++filt"], input="\n".join(left), check=True, capture_output=True, text=True).stdout
    return sorted({n for n in names.splitlines()
                   if n and n.startswith("blockrand::") and not called_in_its_source(n, sources)})


TEST = re.compile(r"^[ \t]*TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\)\s*\{", re.M)
DONE = re.compile(r"^\| ([A-Z][A-Z0-9]*-?\d+) \|[^|]*\| done \|(.*)\|\s*$", re.M)


def bodies_of_tests(sources):
    """"Suite.Name" -> its body, from the texts of test sources: up to the first brace at the start of a line."""
    bodies = {}
    for text in sources:
        for found in TEST.finditer(text):
            end = text.find("\n}", found.end())
            bodies[f"{found.group(1)}.{found.group(2)}"] = text[found.end():end if end >= 0 else len(text)]
    return bodies


def proved_by_the_dead(dead, ledger, bodies):
    """Rows of docs/internal/seeds.md that are done by a test that calls a function which no command reaches."""
    names = {short_name(name) for name in dead}
    complaints = []
    for row, reason in DONE.findall(ledger):
        for test in re.findall(r"`([A-Z]\w*\.[A-Z]\w*)`", reason):
            for name in sorted(names):
                if re.search(r"(?<!\w)" + re.escape(name) + r"\s*\(", bodies.get(test, "")):
                    complaints.append(f"{row} is done by {test}, which calls {name}: no command does")
    return complaints


def ledger_and_tests():
    texts = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "tests" / "unit").rglob("*.cpp"))]
    return (ROOT / "docs" / "internal" / "seeds.md").read_text(encoding="utf-8"), bodies_of_tests(texts)


def main(arguments, sources):
    if len(arguments) not in (1, 2):
        raise SystemExit(__doc__)
    if "X86-64" not in output("readelf", "-h", arguments[0]):
        print("unreachable: this machine code is not read: skipped")
        return 77
    found = unreachable(arguments[0], sources)
    if len(arguments) == 1:
        print("\n".join(found))
        return 0
    lines = pathlib.Path(arguments[1]).read_text(encoding="utf-8").splitlines()
    allowed = {line.strip() for line in lines if line.strip() and not line.startswith("#")}
    new, stale = sorted(set(found) - allowed), sorted(allowed - set(found))
    for name in new:
        print(f"unreachable: only tests call {name}")
    for name in stale:
        print(f"unreachable: {name} is reached or gone: strike it from {arguments[1]}")
    unproved = proved_by_the_dead(found, *ledger_and_tests())
    for complaint in unproved:
        print(f"unreachable: {complaint}")
    print(f"unreachable: {len(found)} functions, {len(allowed)} allowed, {len(new)} new, {len(stale)} stale")
    return 1 if new or stale or unproved else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], product_sources()))
