#!/bin/sh
# One picture per roof shape with all plans of grid.txt side by side, rows of five from the north.
#   contact_sheet.sh TEST_PROGRAM OUT_FOLDER      for example: contact_sheet.sh build/release/tests/test_roof_grid /tmp/roofs
# Of test_roof_edges: eaves, parapets, firewalls, caps on four plans, free-standing and between neighbours, and gables:
#   FROM=60,60,75 TO=35,8,20 contact_sheet.sh build/release/tests/test_roof_edges /tmp/roof_edges
#   FROM=35,40,125 TO=35,0,50 contact_sheet.sh build/release/tests/test_roof_elements /tmp/elements    dormers and all that stands on roofs
# LOOK is a copy of ../shared/tools/render in which `npm install` has run. SHAPES limits which: SHAPES="gabled onion".
set -eu
program=$1 out=$2
look=${LOOK:?"a copy of shared/tools/render with its node_modules"}
mkdir -p "$out"
ROOF_GRID_GLB=$out ROOF_EDGES_GLB=$out ROOF_ELEMENTS_GLB=$out "$program" --gtest_filter='*Pictures.*' >/dev/null
for glb in "$out"/*.glb; do
  shape=$(basename "$glb" .glb)
  case " ${SHAPES:-$shape} " in *" $shape "*) ;; *) continue ;; esac
  node "$look/look.mjs" "$out/$shape.png" "$glb" --from "${FROM:-85,150,215}" --to "${TO:-99,5,36}" --fov 34 --size 2000x1100 >/dev/null
  echo "$out/$shape.png"
done
