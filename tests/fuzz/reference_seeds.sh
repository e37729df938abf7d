#!/bin/sh
# Writes one small model of each format into FOLDER, as seeds for fuzz_reference.
#   tests/fuzz/reference_seeds.sh FOLDER
set -eu
out=$1
ground='390000 5820000 30 390000 5820008 30 390010 5820008 30 390010 5820000 30 390000 5820000 30'
{
  printf '\000'
  cat <<EOF
<CityModel xmlns="http://www.opengis.net/citygml/2.0" xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:gml="http://www.opengis.net/gml" xmlns:xlink="http://www.w3.org/1999/xlink"><gml:description>heights: heights above local ground</gml:description>
<cityObjectMember><bldg:Building gml:id="b"><bldg:measuredHeight uom="m">9</bldg:measuredHeight><bldg:lod2Solid><gml:Solid><gml:exterior><gml:CompositeSurface><gml:surfaceMember xlink:href="#p"/></gml:CompositeSurface></gml:exterior></gml:Solid></bldg:lod2Solid>
<bldg:outerBuildingInstallation><bldg:BuildingInstallation><bldg:lod3ImplicitRepresentation><ImplicitGeometry><transformationMatrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transformationMatrix><relativeGMLGeometry><gml:MultiSurface gml:id="t"><gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>0 0 0 1 0 0 1 1 0 0 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember></gml:MultiSurface></relativeGMLGeometry><referencePoint><gml:Point><gml:pos>390000 5820000 30</gml:pos></gml:Point></referencePoint></ImplicitGeometry></bldg:lod3ImplicitRepresentation></bldg:BuildingInstallation></bldg:outerBuildingInstallation>
<bldg:boundedBy><bldg:GroundSurface><bldg:lod2MultiSurface><gml:MultiSurface><gml:surfaceMember><gml:Polygon gml:id="p"><gml:exterior><gml:LinearRing><gml:posList>$ground</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:surfaceMember></gml:MultiSurface></bldg:lod2MultiSurface></bldg:GroundSurface></bldg:boundedBy></bldg:Building></cityObjectMember></CityModel>
EOF
} >"$out/citygml"
objects='"CityObjects":{"b":{"type":"Building","attributes":{"measuredHeight":9},"children":["p"],"geometry":[{"type":"Solid","lod":"2.2","boundaries":[[[[0,1,2]],[[0,2,3],[1,2,3]]]],"semantics":{"surfaces":[{"type":"WallSurface"},{"type":"Window","parent":0}],"values":[[0,1]]}}]},"p":{"type":"BuildingPart","parents":["b"],"geometry":[{"type":"GeometryInstance","template":0,"boundaries":[0],"transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}},"vertices":[[0,0,0],[9,0,0],[9,9,0],[0,9,9]]'
transform='"transform":{"scale":[0.001,0.001,0.001],"translate":[390000,5820000,0]}'
templates='"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}],"vertices-templates":[[0,0,0],[1,0,0],[1,1,0]]}'
printf '\001{"type":"CityJSON","version":"2.0",%s,%s,%s}' "$transform" "$templates" "$objects" >"$out/cityjson"
printf '\001{"type":"CityJSON","version":"2.0",%s,%s,"CityObjects":{},"vertices":[]}\n{"type":"CityJSONFeature","id":"b",%s}\n' \
  "$transform" "$templates" "$objects" >"$out/sequence"
# Three corners of one triangle, then their feature ids, then the texts "AB" with their offsets.
buffer='AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAQUIAAAAAAAABAAAAAgAAAA=='
gltf='{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[1,2,3],"rotation":[0,0,0,1],"children":[1]},{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"_FEATURE_ID_0":1},"extensions":{"EXT_mesh_features":{"featureIds":[{"attribute":0,"featureCount":1,"propertyTable":0}]}}}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},{"bufferView":1,"componentType":5121,"type":"SCALAR","count":3,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":1}}}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":4},{"buffer":0,"byteOffset":40,"byteLength":2},{"buffer":0,"byteOffset":44,"byteLength":12}],"extensions":{"EXT_structural_metadata":{"schema":{"classes":{"c":{"properties":{"id":{"type":"STRING"}}}}},"propertyTables":[{"class":"c","count":2,"properties":{"id":{"values":2,"stringOffsets":3}}}]}},"buffers":[{"byteLength":56,"uri":"data:;base64,'$buffer'"}]}'
printf '\002%s' "$gltf" >"$out/gltf"
printf '\003{"asset":{"version":"1.1"},"geometricError":1,"root":{"refine":"ADD","transform":[-0.23,0.97,0,0,-0.77,-0.18,0.61,0,0.59,0.14,0.79,0,3786000,902000,5037000,1],"geometricError":0,"children":[{"content":{"uri":"f.glb"}},{"content":{"uri":"tileset.json"}}]}}' >"$out/tileset"
printf '\004%s' "$gltf" >"$out/any"
