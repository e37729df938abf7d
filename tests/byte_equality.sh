#!/bin/sh
# Whether two programs write the same bytes: the proof that a change of the code's form is nothing else.
#   sh tests/byte_equality.sh PROGRAM OUTDIR [--extracts LIST] [--data DIR] [--configs DIR] [--keep]
#   sh tests/byte_equality.sh --compare BEFORE AFTER [--allow WHAT]...
# The first form builds real extracts at LoD 0, 2 and 3 with PROGRAM and looks at the builds as users do. It writes into OUTDIR:
#   hashes.txt   sha256 of every file that the program wrote but run.json (times), sorted by path
#   stdout/      what the commands printed, with messages and exit codes; measured times and memory are blanked
#   --extracts LIST   some of the cases only, separated by commas: zionskirchplatz, husum, helsinki, monaco, ingolstadt,
#                     vinohrady (the six), pariser_platz, settings, commands
#   --data DIR        folder with osm/ and reference/; else ../shared/data beside the repository
#   --configs DIR     the program's configs; else those beside it or in a folder above it
#   --keep            the builds stay in OUTDIR/work (4 GB), to look at what differs; else OUTDIR/work is removed
# The second form names the files that differ, of the cases that both have, and exits with 1 when there are any. --allow says what may differ:
#   max_usual_roof_height   build.json may record this option and does not have to
#   info                    `blockrand info`, its help, and what lists its options (reference, manual, completion)
# All calls run in OUTDIR/work with relative paths, so that no path of this machine can reach an output.
set -eu

usage() {
  sed -n '2,17p' "$0" | sed 's/^# \{0,1\}//'
  exit "$1"
}

# ---------------------------------------------------------------------------------------------------------- compare

compare() {
  python3 - "$@" <<'PY'
import difflib, os, sys

before, after = sys.argv[1], sys.argv[2]
allowed = set()
rest = sys.argv[3:]
while rest:
    if rest[0] != '--allow' or len(rest) < 2 or rest[1] not in ('max_usual_roof_height', 'info'):
        sys.exit(f'byte_equality: unknown argument {" ".join(rest[:2])}')
    allowed.add(rest[1])
    rest = rest[2:]

ROOF = ' without max_usual_roof_height'
INFO = ('info', 'help_info', 'help_options_markdown', 'help_man', 'help_completion')


def hashes(folder):
    with open(os.path.join(folder, 'hashes.txt'), encoding='utf-8') as f:
        rows = [line.rstrip('\n').split('  ', 1) for line in f]
    return {path: digest for digest, path in rows if not path.endswith(ROOF)}, \
           {path[:-len(ROOF)]: digest for digest, path in rows if path.endswith(ROOF)}


def texts(folder):
    out = {}
    for name in sorted(os.listdir(os.path.join(folder, 'stdout'))):
        with open(os.path.join(folder, 'stdout', name), encoding='utf-8', errors='replace') as f:
            out['stdout/' + name] = f.read()
    return out


CASES = ('zionskirchplatz', 'husum', 'helsinki', 'monaco', 'ingolstadt', 'vinohrady', 'pariser_platz', 'settings')


def case_of(path):
    if path.startswith(('stdout/districts_show', 'stdout/districts_diff')):
        return 'vinohrady'
    return next((c for c in CASES if c in path), 'commands')


def cases(folder):
    with open(os.path.join(folder, 'cases.txt'), encoding='utf-8') as f:
        return set(f.read().split(','))


common = cases(before) & cases(after)


def of_common(found):
    return {path: what for path, what in found.items() if case_of(path) in common}


files_a, roof_a = map(of_common, hashes(before))
files_b, roof_b = map(of_common, hashes(after))
texts_a, texts_b = of_common(texts(before)), of_common(texts(after))
print('cases that both have: ' + ', '.join(sorted(common)))
wrong, granted = [], []
for path in sorted(files_a.keys() | files_b.keys()):
    a, b = files_a.get(path), files_b.get(path)
    if a == b:
        continue
    if a is None or b is None:
        wrong.append(f'{path}: only {"before" if b is None else "after"}')
    elif 'max_usual_roof_height' in allowed and path in roof_a and roof_a[path] == roof_b.get(path):
        granted.append(f'{path}: max_usual_roof_height')
    else:
        wrong.append(f'{path}: differs')
for path in sorted(texts_a.keys() | texts_b.keys()):
    a, b = texts_a.get(path), texts_b.get(path)
    if a == b:
        continue
    if a is None or b is None:
        wrong.append(f'{path}: only {"before" if b is None else "after"}')
        continue
    lines = list(difflib.unified_diff(a.splitlines(), b.splitlines(), lineterm='', n=0))[2:]
    shown = ''.join(f'\n    {line[:200]}' for line in lines[:30]) + (f'\n    … {len(lines) - 30} more lines' if len(lines) > 30 else '')
    name = os.path.basename(path)[:-len('.txt')]
    if 'info' in allowed and name.startswith(INFO):
        granted.append(f'{path}: info{shown}')
    else:
        wrong.append(f'{path}: differs{shown}')
print(f'{len(files_a)} files and {len(texts_a)} texts before, {len(files_b)} and {len(texts_b)} after')
for what in granted:
    print('allowed   ' + what)
for what in wrong:
    print('DIFFERENT ' + what)
if not files_a or not texts_a:
    wrong.append('nothing was compared')
print(f'{len(wrong)} differences, {len(granted)} allowed ones' if wrong else f'the same bytes, {len(granted)} allowed differences')
sys.exit(1 if wrong else 0)
PY
}

case ${1:-} in
  -h | --help) usage 0 ;;
  --compare)
    [ $# -ge 3 ] || usage 1
    shift
    compare "$@"
    exit ;;
esac
[ $# -ge 2 ] || usage 1

# ------------------------------------------------------------------------------------------------------------ set up

root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
program=$(realpath "$1")
mkdir -p "$2"
out=$(realpath "$2")
shift 2
cases=zionskirchplatz,husum,helsinki,monaco,ingolstadt,vinohrady,pariser_platz,settings,commands
data=$root/../shared/data
configs=
keep=no
while [ $# -gt 0 ]; do
  case $1 in
    --extracts) cases=$2; shift 2 ;;
    --data) data=$2; shift 2 ;;
    --configs) configs=$(realpath "$2"); shift 2 ;;
    --keep) keep=yes; shift ;;
    *) usage 1 ;;
  esac
done
[ -x "$program" ] || { echo "byte_equality: $program is not built" >&2; exit 1; }
[ -d "$data/osm" ] || { echo "byte_equality: no real data at $data" >&2; exit 1; }
data=$(realpath "$data")

# The configs that the program would find, or those of the tree it was built in.
folder=$(dirname "$program")
while [ -z "$configs" ]; do
  for c in "$folder/configs" "$folder/share/blockrand/configs"; do
    if [ -z "$configs" ] && [ -f "$c/defaults/uses.toml" ]; then configs=$(realpath "$c"); fi
  done
  [ "$folder" != / ] || break
  folder=$(dirname "$folder")
done
[ -n "$configs" ] || { echo "byte_equality: no configs beside $program; name them with --configs" >&2; exit 1; }

work=$out/work
rm -rf "$work" "$out/stdout" "$out/hashes.txt" "$out/cases.txt"
mkdir -p "$work" "$out/stdout"
ln -s "$data/osm" "$work/osm"
ln -s "$data/reference" "$work/reference"
ln -s "$configs" "$work/configs"
cd "$work"
: >hashes
echo "byte_equality: $program, sha256 $(sha256sum <"$program" | cut -c1-16), configs $configs"

# look NAME ARGUMENTS...: runs the program and appends to stdout/NAME.txt what it says. Times, memory and the place of the folder are blanked.
look() {
  name=$1
  shift
  code=0
  "$program" "$@" >said 2>told </dev/null || code=$?
  {
    printf '$ blockrand %s\n' "$*"
    sed -E -e '/, peak memory /d' -e 's/^[0-9.]+ [a-zA-Z]+ in ([0-9,]+ files:)$/SIZE in \1/' \
      -e 's/^(A build would take ).* of memory and/\1TIME, SIZE of memory and/' \
      -e '/^ "estimate"|^  "estimate"/,/}/s/("seconds"|"memory_bytes"): [-+.e0-9]+/\1: BLANK/' said
    sed -e "s|$work/||g" -e 's/^/stderr: /' told
    echo "exit code $code"
    echo
  } >>"$out/stdout/$name.txt"
  last_code=$code
}

# hash FOLDER: of every file but run.json. Of build.json a second time without the key that one of the trees lacks.
hash() {
  find "$1" -type f ! -name run.json -print0 | LC_ALL=C sort -z | xargs -0 sha256sum >>hashes
  if [ -f "$1/build.json" ]; then
    python3 - "$1/build.json" >>hashes <<'PY'
import hashlib, re, sys
text = open(sys.argv[1], encoding='utf-8').read()
key = r'"max_usual_roof_height": [-+.e0-9]+'
text = re.sub(r',\s*' + key, '', text, count=1) if re.search(r',\s*' + key, text) else re.sub(key + r',\s*', '', text, count=1)
print(f'{hashlib.sha256(text.encode()).hexdigest()}  {sys.argv[1]} without max_usual_roof_height')
PY
  fi
}

# build NAME EXTRACT OPTIONS...: into builds/NAME, hashed.
build() {
  target=$1
  shift
  case " $* " in *" --lod "* | *" --config "*) ;; *) set -- "$@" --lod 2 ;; esac
  look "build_$target" build "$@" -o "builds/$target" --configs configs --progress none
  if [ "$last_code" -ne 0 ]; then
    echo "byte_equality: the build $target ended with exit code $last_code:" >&2
    tail -n 3 told >&2
    [ -d "builds/$target" ] || exit 1
  fi
  hash "builds/$target"
}

# levels NAME EXTRACT OPTIONS...: builds of LoD 0, 2 and 3 as builds/NAME_0, _2, _3.
levels() {
  of=$1
  shift
  for lod in 0 2 3; do build "${of}_$lod" "$@" --lod $lod; done
}

# tile NAME EXTRACT OPTIONS...: of each of the builds NAME_0, _2, _3 one tile alone.
tile() {
  of=$1
  shift
  for lod in 0 2 3; do
    chosen=$(python3 - "builds/${of}_$lod/build.json" <<'PY'
import json, re, sys
files = json.load(open(sys.argv[1], encoding='utf-8'))['files']
tiles = sorted((f['bytes'], n) for n, f in files.items() if re.fullmatch(r'cityjson/\d+_\d+_\d+\.city\.jsonl', n))
print(tiles[len(tiles) * 3 // 4][1][len('cityjson/'):].split('.')[0].replace('_', '/'))
PY
    )
    build "${of}_${lod}_tile" "$@" --lod $lod --tile "$chosen" --pinned "builds/${of}_$lod/build.json"
  done
}

# explain NAME COUNT: so many buildings of builds/NAME, spread over all of them, in each form, and objects without a model.
explain() {
  python3 - "builds/$1" "$2" >ids <<'PY'
import json, sqlite3, sys
folder, count = sys.argv[1], int(sys.argv[2])
rows = sqlite3.connect(f'file:{folder}/buildings.gpkg?mode=ro', uri=True)
ids = [r[0] for r in rows.execute('select id from buildings order by id')]
parts = [r[0] for r in rows.execute('select id from parts where id like "%.%" order by id')]
objects = [o['id'] for o in json.load(open(f'{folder}/report.json', encoding='utf-8'))['objects']]


def spread(all_, n):
    return [all_[(2 * i + 1) * len(all_) // (2 * n)] for i in range(n)] if all_ else []


print('\n'.join(dict.fromkeys(spread(ids, count - 3) + spread(parts, 1) + spread(objects, 2))))
PY
  while read -r id; do
    look "explain_$1" explain "builds/$1" "$id"
    look "explain_$1_edges" explain "builds/$1" "$id" --edges
    look "explain_$1_style" explain "builds/$1" "$id" --style --edges
    look "explain_$1_json" explain "builds/$1" "$id" --json
  done <ids
}

# info NAME EXTRACT OPTIONS...: what is in the extract.
info() {
  of=$1
  shift
  look "info_$of" info "$@" --progress none
  look "info_$of" info "$@" --progress none --json
}

# done_with NAME: room for the next.
done_with() {
  [ $keep = yes ] || rm -rf "builds/$1"_*
  echo "byte_equality: $1 done"
}

# ------------------------------------------------------------------------------------------- inputs that are made here

# A slope with a hump and a step over the extract, by whole numbers only, so that no libm can change it.
make_terrain() {
  python3 - <<'PY'
west, south, cell, columns, lines = 370600, 4841400, 5, 1100, 1000
with open('hill.asc', 'w', encoding='utf-8') as f:
    f.write(f'ncols {columns}\nnrows {lines}\nxllcorner {west}\nyllcorner {south}\ncellsize {cell}\n')
    for r in range(lines):
        row = []
        for c in range(columns):
            dx, dy = c - 420, lines - r - 500
            mm = 60000 - 900 * dx + 1100 * dy + 40000 * 1600 // (1600 + dx * dx + dy * dy) + (3000 if (c // 90 + r // 110) % 5 == 0 else 0)
            row.append(f'{mm // 1000}.{mm % 1000:03d}' if mm >= 0 else f'-{-mm // 1000}.{-mm % 1000:03d}')
        f.write(' '.join(row) + '\n')
with open('hill.prj', 'w', encoding='utf-8') as f:
    f.write('PROJCS["ETRS_1989_UTM_Zone_32N",GEOGCS["GCS_ETRS_1989",DATUM["D_ETRS_1989",SPHEROID["GRS_1980",6378137,'
            '298.257222101]],PRIMEM["Greenwich",0],UNIT["Degree",0.017453292519943295]],PROJECTION["Transverse_Mercator"],'
            'PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],'
            'PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["Meter",1]]')
PY
}

# Orders of every kind for buildings, parts, storeys, edges and bays of an extract in XML.
make_overrides() {
  python3 - "$1" <<'PY'
import gzip, sys
import xml.etree.ElementTree as tree

root = tree.parse(gzip.open(sys.argv[1])).getroot()
at = {n.get('id'): (float(n.get('lon')), float(n.get('lat'))) for n in root.iter('node')}
ways = {}
for way in root.iter('way'):
    nodes = [n.get('ref') for n in way.iter('nd')]
    tags = {t.get('k'): t.get('v') for t in way.iter('tag')}
    if len(nodes) > 3 and nodes[0] == nodes[-1] and all(n in at for n in nodes):
        ways[int(way.get('id'))] = (nodes, tags)
houses = sorted(w for w in ways if ways[w][1].get('building', 'no') != 'no')
parts = sorted(w for w in ways if 'building:part' in ways[w][1] and 'building' not in ways[w][1])


def box(way):
    lons, lats = zip(*(at[n] for n in ways[way][0]))
    return min(lons), min(lats), max(lons), max(lats)


def longest_edge(way):
    """As outputs name it: by the nodes at its ends, the ground on the left."""
    nodes = ways[way][0]
    ends = list(zip(nodes, nodes[1:]))
    if sum(at[a][0] * at[b][1] - at[b][0] * at[a][1] for a, b in ends) < 0:
        ends = [(b, a) for a, b in ends]
    a, b = max(ends, key=lambda e: (at[e[0]][0] - at[e[1]][0]) ** 2 + (at[e[0]][1] - at[e[1]][1]) ** 2)
    return f'e{a}_{b}'


def house_of(part):
    w, s, e, n = box(part)
    x, y = (w + e) / 2, (s + n) / 2
    for house in houses:
        b = box(house)
        if b[0] <= x <= b[2] and b[1] <= y <= b[3]:
            return house
    return None


ORDERS = [
    'storeys = 5\nroof_shape = "mansard"\nwall_colour = "#d8c9a3"\npreset = "gz_ornate"',
    'height = 21.5\nroof_height = 4\nroof_shape = "hipped"\nroof_colour = "#803020"',
    'eaves_height = 12\nroof_height = 5\nroof_shape = "gabled"\nridge_direction = 40',
    'roof_shape = "gabled"\nroof_orientation = "across"\nroof_pitch = 38',
    'storey_height = 3.9\nstoreys = 4\nplinth_height = 0.9',
    'roof_shape = "flat"\nstoreys = 7\nwall_material = "concrete"\nroof_material = "gravel"\nera = "post1945"\nstyle = "modern"',
    'roof_shape = "skillion"\nroof_direction = 200\nroof_height = 2.5',
    'roof_shape = "round"\nroof_height = 3',
    'roof_shape = "half-hipped"\nroof_storeys = 1',
    'roof_shape = "pyramidal"\nroof_height = 8',
    'construction_date = "1895..1902"\nground_floor_use = "shop"\nera = "1840_1918"\nstyle = "gruenderzeit"',
    'style = "tenement"\nuse = "apartments"\npreset = "tenement_workers"',
    'min_height = 3\nheight = 18',
    'roof_shape = "gambrel"\nground_height = 12',
    'preset = "slab"\nstoreys = 11\nroof_shape = "flat"',
    'preset = "bilke_gruenderzeit"\nstoreys = 5',
    'preset = "plain"',
    'roof_shape = "saltbox"', 'roof_shape = "dome"\nroof_height = 6', 'roof_shape = "onion"\nroof_height = 7',
]
DETAILS = [
    '[{id}.storey.0]\nheight = 4.8\nuse = "shop"\ncolour = "#c0b090"\n',
    '[{id}.storey.1]\nmaterial = "brick"\nparameters = {{ window = "none" }}\n',
    '[{id}.edge."{edge}"]\nkind = "courtyard"\nwall_thickness = 0.45\n',
    '[{id}.edge."{edge}"]\nkind = "street"\ncolour = "#a0a0ff"\n',
    '[{id}.bay.1]\nwidth = 2.6\nparameters = {{ window = "none" }}\n',
    '[{id}.bay.0]\nparameters = {{ use = "balcony" }}\n',
]
text = ''
step = max(1, len(houses) // 60)
chosen = houses[::step][:60]
for i, house in enumerate(chosen):
    text += f'[w{house}]\n{ORDERS[i % len(ORDERS)]}\n'
    for d in (i, i + 3)[:1 + i % 2]:
        text += DETAILS[d % len(DETAILS)].format(id=f'w{house}', edge=longest_edge(house))
for i, part in enumerate(parts[::3]):
    house = house_of(part)
    if house and house not in chosen:
        text += f'[w{house}.w{part}]\n' + ('height = 31.5\n', 'roof_shape = "flat"\n', 'roof_colour = "#404040"\n')[i % 3]
text += '[w1]\nstoreys = 3\n[r2]\nheight = 9\n'
with open('overrides.toml', 'w', encoding='utf-8') as f:
    f.write(text)
PY
}

# Every number of the configuration another than its default; every switch of repair taken back.
make_settings() {
  cat >numbers.toml <<'TOML'
[build]
seed = 7
ground_height = 34
districts = "leipzig"
crs = "EPSG:25832"
[repair]
duplicate_distance = 0.004
spike_width = 0.03
min_piece_area = 0.1
max_ring_area_change = 0.2
ring_clearance = 0.05
collinear_distance = 0.05
snap_distance = 0.6
snap_reach = 1.1
snap_angle = 0.15
min_overlap = 1.5
max_shift = 0.7
max_area_change = 0.2
min_overlap_area = 0.2
max_loss = 0.4
parts_free_area = 20
parts_free_width = 2
[generate]
neighbour_reach = 60
neighbour_minimum = 2
min_wall_height = 0.5
max_usual_roof_height = 6
min_roof_height = 0.2
max_roof_pitch = 55
canopy_thickness = 0.4
collinear_tolerance = 0.02
simplify_tolerance = 0.3
TOML
  cat >switches.toml <<'TOML'
[build]
instancing = "nodes"
compress = "meshopt"
gzip = true
[repair]
simplify = false
share_walls = false
resolve_overlaps = false
settle_coverings = false
square = false
fit_parts = false
arcs = false
TOML
}

# A rule file that uses what rule files use most, and facade rules in XML to import.
make_rules() {
  mkdir -p rules
  cat >rules/house.cga <<'CGA'
attr height = 14
attr storey = 3.2
const red = "#a03020"
@StartRule
Lot --> report("lot", geometry.area) setback(2){ front : Garden | remainder : Footprint }
Footprint --> extrude(height) comp(f){ front : Front | side : Side | top : Roof | bottom : NIL }
Front --> split(y){ 4 : Ground | { ~storey : Floor(split.index) }* | 0.6 : Cornice }
Ground --> split(x){ ~1 : Wall | 1.4 : Door | ~1 : Wall }
Floor(i) --> color(rand(0.5, 1), 0.5, 0.3) split(x){ ~0.8 : Wall | { ~2.4 : Bay(i) }* | ~0.8 : Wall }
Bay(i) --> case i == 0 : Wall else : 40% : Wall else : Window
Window --> split(x){ 0.5 : Wall | ~1 : t(0, 0, -0.2) color("#8090a0") report("glass", geometry.area) Glass. | 0.5 : Wall }
Door --> t(0, 0, -0.3) extrude(0.05) color(red) Leaf.
Cornice --> extrude(0.4) Cornice.
Side --> split(y){ { ~storey : Wall }* }
Wall --> color("#d8c9a3") Wall.
Roof --> 30% : roofGable(35, 0.4) Tiles 30% : roofHip(40, 0.3) Tiles else : [ offset(-0.5, inside) Flat ] offset(-0.5, border) Parapet
Tiles --> comp(f){ all : color("#803020") report("roof", geometry.area) Tile. }
Flat --> print("flat") Flat.
Parapet --> extrude(0.9) Parapet.
Garden --> scatter(surface, 5, uniform){ Tree }
Tree --> s(1, 3, 1) primitiveCylinder(8) Tree.
CGA
  cat >rules/wrong.cga <<'CGA'
attr a = 1
Lot --> extrud(3) Mass
Mass --> comp(f){ side : Wall | top Roof }
Unused --> split(x){ 1 : A }
CGA
  cat >rules/tested.cga <<'CGA'
// expect: lot 10x20; leaves W. 4; report area sum 1800; report area max 600
// expect: lot 10x20; leaves W. 5
Lot --> extrude(30) comp(f){ side : W }
W   --> report("area", geometry.area) W.
CGA
  cat >rules/facade.xml <<'XML'
<?xml version="1.0" encoding="UTF-8"?>
<Rulefile name="FacadeStructure">
  <Rule><Predecessor>FrontFacade</Predecessor><Rules><Probability value="1">
    <Split axis="u"/>
    <Symbol size="1" property="GroundfloorHeight">Groundfloor</Symbol>
    <Symbol size="1r">Floors</Symbol>
  </Probability></Rules></Rule>
  <Rule><Predecessor>Floors</Predecessor><Rules><Probability value="1">
    <Repeat axis="u" size="1" property="FloorHeight"/><Symbol>Floor</Symbol>
  </Probability></Rules></Rule>
  <Rule><Predecessor>Floor</Predecessor><Rules>
    <Probability value="0.5"><Split axis="r"/><Symbol size="1r">Window</Symbol><Symbol size="2">Wall</Symbol></Probability>
    <Probability value="0.5"><Repeat axis="r" size="3"/><Symbol>Window</Symbol></Probability>
  </Rules></Rule>
  <Rule><Predecessor>Window</Predecessor><Rules><Probability value="1"><Symbol>Window1.wrl</Symbol></Probability></Rules></Rule>
  <BuildingSettings><FloorHeight>3.4</FloorHeight></BuildingSettings>
</Rulefile>
XML
}

# --------------------------------------------------------------------------------------------------------- the cases

zionskirchplatz() {  # Perimeter blocks; everything in single files, with evidence.
  extract=osm/berlin-zionskirchplatz-2020.osm
  levels zionskirchplatz $extract --evidence --single-glb --single-cityjson
  look validate_zionskirchplatz_3 validate builds/zionskirchplatz_3 --progress none
  look validate_zionskirchplatz_3 validate builds/zionskirchplatz_0 --json --extract $extract --progress none
  explain zionskirchplatz_3 10
  info zionskirchplatz $extract
  info zionskirchplatz $extract --bbox 13.398,52.535,13.402,52.537
}

husum() {  # Old town of gables; compressed.
  extract=osm/husum_altstadt.osm.pbf
  levels husum $extract --gzip --compress meshopt
  look validate_husum_2 validate builds/husum_2 --progress none
  explain husum_2 9
  info husum $extract
}

helsinki() {  # Parts, relations, missing nodes; one tile alone.
  extract=osm/helsinki-centre-2019.osm.pbf
  levels helsinki $extract
  tile helsinki $extract
  look validate_helsinki_0 validate builds/helsinki_0 --progress none
  explain helsinki_2 10
  explain helsinki_3_tile 6
  info helsinki $extract
}

monaco() {  # Dense and steep; on terrain, a tile alone on it as well.
  extract=osm/monaco-2021.osm.pbf
  make_terrain
  levels monaco $extract --terrain hill.asc --terrain-height-reference sea-level --instancing nodes
  tile monaco $extract --terrain hill.asc --terrain-height-reference sea-level --instancing nodes
  explain monaco_3 9
  info monaco $extract
}

ingolstadt() {  # A whole town centre; compared with models built by hand.
  extract=osm/ingolstadt-altstadt.osm
  levels ingolstadt $extract
  look compare_ingolstadt_3 compare builds/ingolstadt_3 reference/ingolstadt-lod3 -o builds/ingolstadt_compare --pictures 6 --samples 500 --progress none
  hash builds/ingolstadt_compare
  explain ingolstadt_2 9
  info ingolstadt $extract
}

vinohrady() {  # Perimeter blocks with orders of every kind; and which district rules fire.
  extract=osm/prague-vinohrady.osm.gz
  make_overrides $extract
  levels vinohrady $extract --overrides overrides.toml --instancing baked
  explain vinohrady_3 12
  look validate_vinohrady_2 validate builds/vinohrady_2 --progress none
  look districts_show districts show $extract -o builds/vinohrady_preset --configs configs --progress none
  look districts_show districts show $extract -o builds/vinohrady_rule --by rule --districts leipzig --overrides overrides.toml --configs configs --progress none
  look districts_diff districts diff leipzig vienna $extract -o builds/vinohrady.csv --configs configs --progress none
  hash builds/vinohrady_preset
  hash builds/vinohrady_rule
  sha256sum builds/vinohrady.csv >>hashes
  info vinohrady $extract
}

pariser_platz() {  # A box of an extract; compared with a surveyed and with a hand-built model.
  extract=osm/berlin-pariser-platz-2014.osm.pbf
  build pariser_platz_2 $extract --bbox 13.372,52.513,13.386,52.519 --lod 2
  look compare_pariser_platz compare builds/pariser_platz_2 reference/berlin-lod2/Berlin_3890_5819.gml -o builds/pariser_platz_survey --align both --pictures 10 --progress none
  look compare_pariser_platz compare builds/pariser_platz_2 reference/berlin-pariser-platz --json --progress none
  look compare_pariser_platz compare builds/pariser_platz_2 reference/berlin-pariser-platz --baseline builds/pariser_platz_survey/compare.json --progress none
  hash builds/pariser_platz_survey
}

settings() {  # Every option of repair and generation.
  extract=osm/berlin_frankfurter_allee.osm.pbf
  make_settings
  build settings_numbers_2 $extract --config numbers.toml
  build settings_numbers_3 $extract --config numbers.toml --lod 3
  build settings_switches_2 $extract --config switches.toml
  build settings_switches_3 $extract --config switches.toml --lod 3
  build settings_bare_1 $extract --lod 1 --formats gltf,cityjson --no-report --no-explain --strict --jobs 1
  explain settings_numbers_2 5
}

commands() {  # What the program says without a build.
  make_rules
  extract=osm/berlin_frankfurter_allee.osm.pbf
  look help
  look help --help
  look help --version
  look help help
  for command in build explain compare districts grammar validate info help; do
    look help_$command $command --help
    look help_$command help $command
  done
  look help_options_markdown help options --markdown
  look help_options_toml help options --toml
  look help_codes help codes
  look help_man help man
  for shell in bash zsh fish; do look help_completion_$shell help completion $shell; done

  look districts_check districts check --configs configs
  for set in configs/districts/*.toml; do look districts_check districts check "$set" --configs configs; done

  for rules in $(find -L configs/grammars -name '*.cga' | LC_ALL=C sort) rules/house.cga rules/wrong.cga rules/tested.cga; do
    look grammar_check grammar check "$rules"
    look grammar_run grammar run "$rules" --lot 14x11 --storeys 5 --attr building.height=18
    look grammar_test grammar test "$rules"
  done
  for seed in 1 2 3 4 5; do
    look grammar_run_house grammar run rules/house.cga --lot 20x14 --seed $seed --tree -o builds/house_$seed.glb
    sha256sum builds/house_$seed.glb >>hashes
  done
  look grammar_import grammar import rules/facade.xml
  look grammar_import grammar import rules/facade.xml -o builds/facade.cga
  look grammar_import grammar run builds/facade.cga --lot 14x11 --rule FrontFacade

  # What is wrong is told with the same words.
  look wrong
  printf '[w1]\nroof_shape = "gabeled"\n' >shape.toml
  printf '[w1]\nwall_material = "cardboard"\n' >material.toml
  printf '[w1]\nstories = 3\n' >key.toml
  printf '[build]\nlodd = 3\n' >unknown.toml
  printf '[repair]\nsnap_distance = 9\n' >range.toml
  look wrong frobnicate
  look wrong help frobnicate
  look wrong help completion
  look wrong build
  look wrong build nowhere.osm -o builds/wrong --configs configs --progress none
  look wrong build $extract --configs configs
  look wrong build $extract -o builds/wrong --lod 4 --configs configs
  look wrong build $extract -o builds/wrong --lod high --configs configs
  look wrong build $extract -o builds/wrong --formats gml --configs configs
  look wrong build $extract -o builds/wrong --instancing none --configs configs
  look wrong build $extract -o builds/wrong --compress zip --configs configs
  look wrong build $extract -o builds/wrong --tile 15/1/1 --configs configs
  look wrong build $extract -o builds/wrong --bbox 1,2,3 --configs configs
  build empty $extract --bbox 1,2,3,4
  look wrong build $extract -o builds/empty --configs configs --progress none
  look wrong build $extract -o builds/wrong --crs EPSG:4326 --configs configs --progress none
  look wrong build $extract -o builds/wrong --repair-snap-distance 9 --configs configs
  look wrong build $extract -o builds/wrong --configs rules
  look wrong build $extract -o builds/wrong --districts nowhere --configs configs --progress none
  look wrong build $extract -o builds/wrong --terrain rules/house.cga --configs configs --progress none
  for file in shape material key; do
    look wrong build $extract -o builds/wrong --overrides $file.toml --configs configs --progress none
  done
  for file in unknown range; do look wrong build $extract -o builds/wrong --config $file.toml --configs configs; done
  look wrong build $extract -o rules --configs configs --force --progress none
  look wrong explain rules w1
  look wrong explain builds w1x
  look wrong validate rules --progress none
  look wrong compare rules reference/fzk-haus --progress none
  look wrong compare reference/fzk-haus/Building_LOD2-EPSG25832.gml
  look wrong districts frobnicate
  look wrong districts show
  look wrong grammar run rules/nowhere.cga
  look wrong grammar frobnicate rules/house.cga
  look wrong info rules/house.cga --progress none
}

mkdir -p builds
for one in $(printf '%s' "$cases" | tr ',' ' '); do
  case $one in
    zionskirchplatz | husum | helsinki | monaco | ingolstadt | vinohrady | pariser_platz | settings | commands) "$one" ;;
    *) echo "byte_equality: no case $one" >&2; exit 1 ;;
  esac
  done_with "$one"
done
LC_ALL=C sort -k 2 hashes >"$out/hashes.txt"
printf '%s' "$cases" >"$out/cases.txt"
cat "$out/hashes.txt"
cd "$out"
[ $keep = yes ] || rm -rf "$work"
echo "byte_equality: $(grep -vc 'without max_usual_roof_height$' hashes.txt) files, $(find stdout -type f | wc -l) texts of" \
  "$(cat stdout/*.txt | grep -c '^\$ blockrand') calls, in $out"
times >times.txt
echo "byte_equality: CPU of all calls, user and system: $(tail -n 1 times.txt)"
