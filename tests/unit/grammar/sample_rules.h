// A dozen rule texts that together use every form of the language: seeds for robustness tests and fuzzing.
#pragma once

#include <array>
#include <string_view>

namespace blockrand::grammar::test {

inline constexpr std::array<std::string_view, 12> kSampleRules = {
    // Declarations of all kinds, annotations, comments, numbers.
    R"(version "2021.0"
/* Block
   comment */
@Group("Size", 1) @Order(2) @Range(min=3, max=(30+1), stepsize=.5)
attr height = 12.5 // metres
@Color attr colour = "#ff8800"   # not a comment in the text
@Hidden
attr flags = [true, false]
const third = 1./3
const pi2 = 3.14159e0 * 2
area(w, h) = w * h
@StartRule
Lot --> extrude(height) Mass
Mass --> comp(f){ side : Facade | top : Roof | all : NIL }
Facade --> color(colour) report("area." + str(1), geometry.area) X.
Roof --> roofHip(byAngle, 30, 0.4, true) color(0.5, .5, 1.)
)",
    // Splits: nesting, repeats, marks, legacy items.
    R"(attr tile = 3
Facade --> split(y){ 4 : Ground | { ~3.2 : Floor(split.index) | 0.2 : Band. }* | '0.05 : Cornice. }
Floor(n) --> split(x, noAdjust){ 0.5 : Wall. | { ~tile : Tile }* | ~tile*2 : Tile | 0.5 : Wall. }
Ground --> split(x){ { 1 : A. | ~2.7 : B. }* | 1 : A. }
Tile --> split(u, unitSpace, 0){ 1 : C. | '1/3 : D. }*
Old --> split(x){ E }
Areas --> splitArea(x, adjust){ 100 : P. | ~50 : Q. }*
Perimeter --> splitAndSetbackPerimeter(0){ 5 : 3 : R. | ~6 : 4 : S. }* { remainder : T. }
)",
    // Choices.
    R"(f(x) = case x > 0 && !(x == 5) || x < -3 : 20% : "a" 30 % : "b" else : "c" case x == 0 : "d" else : "e" + x
Pick --> 30% : Left 2 * 10% : Right else : case comp.index % 2 == 0 : Even. case split.index == split.total - 1 : Last.
         else : 50% : One. else : Two.
Left --> s('0.5, '1, ~2) t(0, 0, -0.1) [ r(0, 90, 0) Part. ] center(xz) Rest
Right --> rand % : Seldom. else : Often.
Rest --> case f(scope.sx) == "a" : NIL else : [ [ ] ] Rest.(2)
)",
    // Components, selectors, setbacks.
    R"(attr edge = 2
A --> comp(f){ front : B | object.side = C | world.up =: D | street.front : E | 3 : F. | edge + 1 : G. | aslant || isTagged("roof.*") : H. | all = I. }
B --> comp(e){ eave : J. | ridge = K. | hip : L. | valley : M. } comp(fe, zUp){ all : N. } comp(v){ border : O. }
C --> setback(3){ front : P. | uv.left = Q. | remainder : R. } setback([1,2,3]){ all : S. }
D --> shapeL(4, 5){ shape : T. | remainder : U. } shapeO(1,2,3,4){ shape : V. } innerRectangle(scope){ shape = W. | remainder : X. }
E --> setbackToArea(100, [1], [5]){ all = NIL | remainder : Y. } setbackPerEdge(comp(fe){ front : 3 | all : 1 }){ all : Z. }
)",
    // Imports, overrides, redefinitions, dynamic imports.
    R"(import a : "one.cga"
import b(Old, New) : "two.cga" ( h, w = 2 * a.h + self, Roof(p) --> extrude(p) X. [ Y. ], Wall --> case p : A. else : B. )
@Hidden import c : "/ESRI.lib/rules/three.cga" ()
import d : "four.cga" e : "five.cga"
attr h = 3 attr self = 1
a.Roof --> set(a.h, 5) a.Roof2(h)
Lot --> a.Lot b( h = 40, Roof --> NIL ).Lot(2) c().start start b.Wall.
start Begin --> Lot
extension Hook(x, y) --> Hook2. Hook2 --> NIL
)",
    // Styles and bindings.
    R"(attr a = 1
R(x) with ( y := x * a z := y + 1, w := "t" ) --> extrude(z) report(w, y) S
g(n) with ( m := n - 1 ) = case m > 0 : g(m) else : m
S --> X.
style Old
attr a = 2
S --> Y.
style Older extends Old
S --> style start
attr style = 3
start --> style.
)",
    // Arrays, indices, ranges, element-wise operators, the comp function.
    R"(attr m = [1,2;3,4]
f = m[1,0] + [1:5][2] + [4:-1:2][0] + m[0, 0:1]
g = m .+ 1 .* 2 .== m .&& [true,false;true,true] .|| m .<= 3 .- m ./ 2 .% 3 .!= 1 .> 0 .>= 0 .< 9
h = comp(f){ top : geometry.area | side = 2 | all =: 0 }
i = size(m) + nRows([]) + sum(h) + 1.==1
Lot --> set(m[0,0], 3) X[ Y. ]
Part --> case sum(m) > 3 : X(m[1]) [ Y. ] else : Z.
)",
    // New blocks and inlining.
    R"(A --> union{ B | C D } subtract { inline B | [ t(1,0,0) C ] } intersect{ D | B }
B --> inline C inline(unify) { C D } inline (append) C.
C --> scatter(surface, 10, uniform){ D E. } scatter(scope, 3, gaussian, center, '0.2){ X. }
D --> modify(f){ top : extrude(1) } tag("a.b", faces) deleteTags("?.b") E
E --> blockrand.window("casement", "head", "arch", "bars", 2) union(B)
)",
    // Texture, material, strings with odd contents.
    "T --> setupProjection(0, scope.xy, ~1.5, '1, 0, 0, 1) projectUV(0) texture(\"maps\\\\a \\\"b\\\".png\") tileUV(0, "
    "~2, 0)\r\n"
    "set(material.color.r, 0.5) set(trim.vertical, false) set(material.colormap, \"x\ny\")\r\n"
    "normalizeUV(0, uv, collectiveAllFaces) label(\"l\") print(\"p\" + geometry.nFaces) P\r\n"
    "@Consistent(\"building\")\r\nP --> 33.333% : X. 33.333% : Y. else : Z.\r\n",
    // Scope and pivot, all transformations; functions of texts and lists.
    R"(Lot --> alignScopeToGeometry(zUp, any, world.lowest) alignScopeToGeometry(yUp, auto) alignScopeToAxes() alignScopeToAxes(y)
  alignScopeToGeometryBBox(xy) setPivot(xyz, 1) rotateScope(-90,0,0) mirrorScope(true,false,false) mirror(false,true,false)
  translate(rel, world, 0, 1, 0) rotate(abs, scope, 0, 45, 0) r(scopeCenter, 0, 0, 5) extrude(world.up.flatTop, 10)
  i("builtin:cube") i("a.obj", yUp, keepSizeAndPosition) primitiveCube primitiveCylinder(12, 1, 2) convexify innerRect
  cleanupGeometry(all, 0.1) reverseNormals setNormals(auto) envelope(normal, 20, 3, 45, 2, 30) offset(-1, inside) Lot2
Lot2 --> case touches(inter) || inside(intra, "l") : X. else : taper(2) Y.
l = listItem("a;b;c;", listSize("a;") - 1) + getRange("a.b.c", ".", ".") + substring("abc", 1) + colorRamp("spectrum", 0.3)
c = convert(x, scope, world, pos, 0, 0, 0) + minimumDistance(inter, "road") + edgeAttr.getFloat("w") + assetInfo("a.obj", sx)
)",
    // Mistakes of all kinds.
    R"(A -- > B
B --> s(1,1 C
C --> exturde(3) spilt(x){ 1 : D } comp(f){ top D }
attr = 5
attr x 5
import file
D --> split(x){ 1 : E
E --> case y : F
F --> G ) ] }
H --> s(1,1,1) case 1 > 2 : I else : J
'K --> L
f(a,a) = a + + ~2
M. --> N
style a-b
? § “quotes” ’1
O --> "unclosed
)",
    // Many things at once, deep nesting.
    "A --> case ((((((1 + 2) * 3) - 4) / 5) % 6) > 7) : split(x){ 1 : split(y){ 1 : split(z){ { { { 1 : [ [ [ X. ] ] ] "
    "}* }* }* } } }\n"
    "else : case true : case false : B else : C else : 10% : 20% : D else : E else : F\n"
    "B(a,b,c,d,e) --> B(-(-(-a)), !!b, [c,[d]], f(f(f(e))), case a : b else : c)\nf(x)=x\n",
};

}  // namespace blockrand::grammar::test
