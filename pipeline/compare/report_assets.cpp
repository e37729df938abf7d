#include "pipeline/compare/comparison_sections.h"

namespace blockrand::compare {

const std::string_view kCompareStyle = R"css(
:root { --r: #0f6cae; --m: #d1590a; --field: #ffffff; --bar: #8b95a1; --good: #1b7f5f; --bad: #b3382c; }
@media (prefers-color-scheme: dark) { :root { --r: #6ab4ec; --m: #f59a52; --field: #1d2023; --bar: #8b95a1; --good: #5fc6a2; --bad: #ff8a7c; } }
body { max-width: 78rem; }
h1 .side { border-bottom: .14em solid; padding-bottom: .02em; } h1 .r { border-color: var(--r); } h1 .m { border-color: var(--m); }
details { margin: .35rem 0; } summary { cursor: pointer; padding: .3rem 0; } summary:hover { color: var(--link); }
.key { display: flex; flex-wrap: wrap; gap: .25rem 1.2rem; margin: .7rem 0; padding: 0; list-style: none; font-size: .9rem; max-width: none; }
.objects { columns: 22rem auto; column-gap: 2rem; list-style: none; padding: 0; margin: .2rem 0; max-width: none; font-size: .9rem; } .objects li { break-inside: avoid; overflow-wrap: anywhere; }
td.about details { margin: 0; } td.about summary { padding: 0; color: var(--soft); font-size: .9em; } td.about ul { margin: .2rem 0; padding-left: 1.1rem; overflow-wrap: anywhere; }
.search { width: 100%; max-width: 24rem; font: inherit; padding: .4rem .7rem; border: 1px solid var(--line); border-radius: .4rem; background: var(--card); color: var(--ink); }
footer { margin-top: 4rem; padding-top: 1rem; border-top: 1px solid var(--line); color: var(--soft); font-size: .88rem; }
.good { color: var(--good); } .bad { color: var(--bad); } .fair { color: var(--soft); }
.chip { display: inline-block; width: .8em; height: .8em; border-radius: .15em; border: 1px solid rgba(0, 0, 0, .25); vertical-align: -.04em; }
.chip.r { background: var(--r); } .chip.m { background: var(--m); }
.dotted { display: inline-block; width: .45em; height: .45em; border-radius: 50%; background: var(--ink); vertical-align: .15em; margin: 0 .2em; }
.measures td, .measures th { padding-right: .8rem; } .measures tr.group th { padding-top: 1rem; border-bottom-color: var(--soft); }
.tip { cursor: help; text-decoration: underline dotted var(--soft); text-underline-offset: .2em; }
.note { font-size: .7em; vertical-align: super; margin-left: .25em; color: var(--soft); text-decoration: none; }
.notes { max-width: 60rem; } .notes li:target { background: var(--card); }
.chart { display: block; max-width: 100%; height: auto; } .chart text, .plan text, .elevation text { font-size: 11px; fill: var(--soft); }
text.mid { text-anchor: middle; } text.end { text-anchor: end; }
.grid { stroke: var(--line); fill: none; } .axis { stroke: var(--soft); fill: none; } .ideal { stroke: var(--ink); stroke-dasharray: 3 3; fill: none; }
.hist { fill: var(--bar); } .curve { fill: none; stroke-width: 2; } .curve.r { stroke: var(--r); } .curve.m { stroke: var(--m); stroke-dasharray: 7 3; }
.spot { stroke: var(--paper); stroke-width: 1.5; } .spot.r { fill: var(--r); } .spot.m { fill: var(--m); }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(20rem, 1fr)); gap: 1rem 1.6rem; } .charts figure { margin: 0; } .charts figcaption { color: var(--ink); margin: 0 0 .3rem; } .charts p { margin: .1rem 0 0; }
.confusion td, .confusion th { padding: .35rem .9rem; } td.form { white-space: nowrap; } .hit { font-weight: 650; background: color-mix(in srgb, var(--good) calc(var(--share) * .55), transparent); } .miss { background: color-mix(in srgb, var(--bad) calc(var(--share) * .55), transparent); }
.classes td.bar { width: 9rem; vertical-align: middle; } .classes td.bar span { display: block; height: .7rem; } td.bar .r { background: var(--r); } td.bar .m { background: var(--m); }
table.matches { font-size: .86rem; } table.matches td, table.matches th { padding-right: .7rem; } td.ids { overflow-wrap: anywhere; min-width: 9rem; max-width: 22rem; } table.matches td:first-child { overflow-wrap: anywhere; min-width: 9rem; }
table.matches th.sorts { cursor: pointer; user-select: none; } th[aria-sort=ascending]::after { content: "\2009\25B4"; } th[aria-sort=descending]::after { content: "\2009\25BE"; }
.match { border-top: 1px solid var(--line); margin-top: 1.8rem; padding-top: .2rem; content-visibility: auto; contain-intrinsic-size: auto 60rem; } .match.plain { contain-intrinsic-size: auto 24rem; }
.match > h3 { font-size: 1.15rem; margin-top: .9rem; overflow-wrap: anywhere; } .facts-of { font-size: .86rem; }
.row { display: flex; flex-wrap: wrap; gap: 1rem 2rem; align-items: flex-start; } .row figure { margin: .4rem 0; }
.beside { flex: 1 1 30rem; } .beside p { margin: 0; } .values { columns: 2; margin: .4rem 0; display: block; column-gap: 2rem; } .values tbody { display: contents; }
.values tr { display: grid; grid-template-columns: 1fr 5rem 4.6rem; gap: .5rem; break-inside: avoid; border-bottom: 1px solid var(--line); } .values td { border: 0; padding: .1rem 0; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(16rem, 1fr)); gap: .8rem; margin: .6rem 0; } .pictures figure { margin: 0; } .pictures .none { background: var(--card); border-radius: .5rem; padding: 1rem; color: var(--soft); }
.plan, .elevation svg { background: var(--field); border: 1px solid var(--line); border-radius: .4rem; display: block; max-width: 100%; height: auto; }
.plan path.r, .plan path.m { fill-rule: evenodd; stroke-width: 1.4; fill-opacity: .22; } .plan .r, .elevation .r { fill: var(--r); stroke: var(--r); } .plan .m, .elevation .m { fill: var(--m); stroke: var(--m); } .plan path.m { stroke-dasharray: 5 2; }
.bar { fill: none; stroke: var(--ink); } .north { fill: var(--ink); }
.elevations { display: flex; flex-wrap: wrap; gap: .9rem 1.2rem; align-items: flex-end; } .elevation { margin: 0; min-width: 15rem; max-width: 100%; } .elevation figcaption { font-size: .82rem; }
.elevation .w { fill-opacity: .1; stroke-width: 1; } .elevation .m.w { fill-opacity: .07; stroke-dasharray: 5 2; } .elevation .o { fill-opacity: .38; stroke-width: .8; } .elevation .m.o { fill-opacity: .2; stroke-width: 1.2; }
.elevation.out .r { fill: var(--soft); stroke: var(--soft); } .elevation.out svg { background: var(--card); } .dot { fill: none; stroke: var(--ink); stroke-width: 4; stroke-linecap: round; } .earth { stroke: var(--ink); fill: none; }
.scale-bar { display: flex; flex-wrap: wrap; align-items: center; gap: .7rem; font-size: .9rem; color: var(--soft); } .scale-bar text { font-size: 11px; fill: var(--soft); }
@media (max-width: 40rem) { .values { columns: 1; } }
@media print { html { font-size: 10.5px; } body { max-width: none; padding: 0; } table.matches td, table.matches th { padding-right: .4rem; } td.ids, table.matches td:first-child { min-width: 5rem; } nav, .search { display: none; } h2, h3 { break-after: avoid; } figure, .row, .pictures, .sum { break-inside: avoid; } .match { content-visibility: visible; }
  .wide { overflow: visible; } .wide table { min-width: 0; } a { color: inherit; text-decoration: none; } * { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
)css";

const std::string_view kCompareScript = R"js(
(function () {
  'use strict';
  const table = document.getElementById('all');
  if (!table) return;
  const body = table.tBodies[0], rows = Array.from(body.rows);
  const key = function (row, column) {
    const text = row.cells[column].textContent.trim();
    const number = parseFloat(text.replace('\u2212', '-'));
    return Number.isNaN(number) ? text : number;
  };
  Array.from(table.tHead.rows[0].cells).forEach(function (head, column) {
    head.classList.add('sorts');
    head.tabIndex = 0;
    const sort = function () {
      const down = head.getAttribute('aria-sort') !== 'descending';
      Array.from(table.tHead.rows[0].cells).forEach(function (cell) { cell.removeAttribute('aria-sort'); });
      head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
      const numbers = head.classList.contains('n');
      const keyed = rows.map(function (row, i) { return [key(row, column), i, row]; });
      keyed.sort(function (a, b) {
        const aEmpty = numbers ? typeof a[0] === 'string' : false, bEmpty = numbers ? typeof b[0] === 'string' : false;
        if (aEmpty !== bEmpty) return aEmpty ? 1 : -1;
        if (numbers ? aEmpty : false) return a[1] - b[1];
        const order = numbers ? a[0] - b[0] : String(a[0]).localeCompare(String(b[0]), 'en', { numeric: true });
        return order === 0 ? a[1] - b[1] : down ? -order : order;
      });
      keyed.forEach(function (entry) { body.appendChild(entry[2]); });
    };
    head.addEventListener('click', sort);
    head.addEventListener('keydown', function (event) { if (event.key === 'Enter') sort(); });
  });
  const search = document.createElement('input');
  search.type = 'search';
  search.className = 'search';
  search.placeholder = 'Filter by id or roof form';
  search.setAttribute('aria-label', search.placeholder);
  search.addEventListener('input', function () {
    const wanted = search.value.toLowerCase();
    rows.forEach(function (row) { row.hidden = !row.textContent.toLowerCase().includes(wanted); });
  });
  table.parentNode.parentNode.insertBefore(search, table.parentNode);
}());
)js";

}  // namespace blockrand::compare
