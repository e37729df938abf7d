#include "pipeline/outputs/report/page_assets.h"

namespace blockrand::outputs {

const std::string_view kReportStyle =
    R"css(.sources { width: 100%; } .sources td { border: 0; padding-top: .22rem; padding-bottom: .22rem; vertical-align: middle; }
.sources td:first-child { white-space: nowrap; } .sources td.bar { width: 62%; }
.sources svg { display: block; width: 100%; height: 1.15rem; border-radius: .2rem; }
.key { display: flex; flex-wrap: wrap; gap: .25rem 1.2rem; margin: .7rem 0; padding: 0; list-style: none; font-size: .9rem; max-width: none; }
.key svg { width: .85em; height: .85em; margin-right: .45em; vertical-align: -.06em; }
.key b { font-weight: 500; font-variant-numeric: tabular-nums; color: var(--soft); margin-left: .35em; }
.b1 { fill: #7b3fa0; } .b2 { fill: #1f5fa8; } .b3 { fill: #5b9bd8; } .b4 { fill: #2a9d9d; } .b5 { fill: #1b7f5f; } .b6 { fill: #6b8e23; }
.b7 { fill: #93ba5e; } .b8 { fill: #dfae2e; } .b9 { fill: #d8932f; } .b10 { fill: #cc7a34; } .b11 { fill: #ba643a; } .b12 { fill: #a5513f; }
.b13 { fill: #c9bba6; } .b14 { fill: #8f8b86; }
details { margin: .35rem 0; } summary { cursor: pointer; padding: .3rem 0; } summary:hover { color: var(--link); }
details.code { border-bottom: 1px solid var(--line); margin: 0; } details.code summary { display: flex; gap: .9rem; align-items: baseline; flex-wrap: wrap; padding: .5rem 0; }
details.code summary::before { content: "\25B8"; color: var(--soft); width: .8rem; } details.code[open] summary::before { content: "\25BE"; }
.code .count { min-width: 3.2rem; text-align: right; font-variant-numeric: tabular-nums; font-weight: 650; }
.objects { columns: 17rem auto; column-gap: 2rem; list-style: none; padding: 0 0 .6rem 1.7rem; margin: .2rem 0; max-width: none; font-size: .9rem; }
.objects li { break-inside: avoid; overflow-wrap: anywhere; }
.themes { margin: 1rem 0; } .themes > input { position: absolute; opacity: 0; pointer-events: none; }
.themes > label { display: inline-block; padding: .3rem .95rem; margin: 0 .3rem .4rem 0; border: 1px solid var(--line); border-radius: 2rem; cursor: pointer; font-size: .93rem; }
.themes > input:checked + label { background: var(--ink); color: var(--paper); border-color: var(--ink); }
.themes > input:focus-visible + label { outline: 2px solid var(--link); outline-offset: 2px; }
.frame { position: relative; background: var(--card); border-radius: .5rem; overflow: hidden; margin: .4rem 0; }
.frame > svg { display: block; width: 100%; height: auto; touch-action: pan-y; }
.footprints path { fill: var(--c, var(--soft)); fill-rule: evenodd; } .legend rect { fill: var(--c); }
.far path { stroke: var(--c, var(--soft)); stroke-width: .6px; vector-effect: non-scaling-stroke; } .footprints a:hover path { fill-opacity: .55; }
.marks circle { fill: none; stroke: var(--mark); stroke-width: 4px; vector-effect: non-scaling-stroke; opacity: 0; pointer-events: none; scroll-margin: 40vh 0; }
.marks circle:target { opacity: 1; }
.scale { position: absolute; left: .9rem; right: .9rem; bottom: .7rem; font-size: .8rem; line-height: 1; pointer-events: none; }
.scale .bar { display: block; height: .42rem; border: 2px solid var(--ink); border-top: 0; margin-top: .25rem; } .scale { display: flex; flex-direction: column-reverse; }
.scale .length { text-shadow: 0 0 3px var(--card), 0 0 3px var(--card); }
.north { position: absolute; right: .9rem; top: .7rem; text-align: center; font-size: .8rem; font-weight: 650; line-height: 1.1; pointer-events: none; }
.north svg { display: block; width: .9rem; margin: .1rem auto 0; fill: var(--ink); }
.zoom { position: absolute; left: .8rem; top: .8rem; display: flex; flex-direction: column; gap: .25rem; }
.zoom button { width: 2rem; height: 2rem; font: 1.1rem/1 inherit; border: 1px solid var(--line); border-radius: .35rem; background: var(--paper); color: var(--ink); cursor: pointer; }
.legend { display: none; }
#by-s:checked ~ .legend.of-s, #by-q:checked ~ .legend.of-q, #by-r:checked ~ .legend.of-r, #by-i:checked ~ .legend.of-i { display: flex; }
#by-s:checked ~ .frame .s1, .of-s .c1 { --c: var(--s1); } #by-s:checked ~ .frame .s2, .of-s .c2 { --c: var(--s2); }
#by-s:checked ~ .frame .s3, .of-s .c3 { --c: var(--s3); } #by-s:checked ~ .frame .s4, .of-s .c4 { --c: var(--s4); }
#by-s:checked ~ .frame .s5, .of-s .c5 { --c: var(--s5); } #by-s:checked ~ .frame .s6, .of-s .c6 { --c: var(--s6); }
#by-s:checked ~ .frame .s7, .of-s .c7 { --c: var(--s7); } #by-s:checked ~ .frame .s8, .of-s .c8 { --c: var(--s8); }
#by-q:checked ~ .frame .q1, .of-q .c1 { --c: #7b3fa0; } #by-q:checked ~ .frame .q2, .of-q .c2 { --c: #1f5fa8; }
#by-q:checked ~ .frame .q3, .of-q .c3 { --c: #5b9bd8; } #by-q:checked ~ .frame .q4, .of-q .c4 { --c: #2a9d9d; }
#by-q:checked ~ .frame .q5, .of-q .c5 { --c: #1b7f5f; } #by-q:checked ~ .frame .q6, .of-q .c6 { --c: #6b8e23; }
#by-q:checked ~ .frame .q7, .of-q .c7 { --c: #93ba5e; } #by-q:checked ~ .frame .q8, .of-q .c8 { --c: #dfae2e; }
#by-q:checked ~ .frame .q9, .of-q .c9 { --c: #d8932f; } #by-q:checked ~ .frame .q10, .of-q .c10 { --c: #cc7a34; }
#by-q:checked ~ .frame .q11, .of-q .c11 { --c: #ba643a; } #by-q:checked ~ .frame .q12, .of-q .c12 { --c: #a5513f; }
#by-q:checked ~ .frame .q13, .of-q .c13 { --c: #c9bba6; } #by-q:checked ~ .frame .q14, .of-q .c14 { --c: #8f8b86; }
#by-r:checked ~ .frame .r1, .of-r .c1 { --c: #8d9aa8; } #by-r:checked ~ .frame .r2, .of-r .c2 { --c: #c0533b; }
#by-r:checked ~ .frame .r3, .of-r .c3 { --c: #dd9550; } #by-r:checked ~ .frame .r4, .of-r .c4 { --c: #83508e; }
#by-r:checked ~ .frame .r5, .of-r .c5 { --c: #5f9e8f; } #by-r:checked ~ .frame .r6, .of-r .c6 { --c: #4b7fb5; }
#by-r:checked ~ .frame .r7, .of-r .c7 { --c: #6d6a52; }
#by-i:checked ~ .frame .i0, .of-i .c0 { --c: #b5b1a8; } #by-i:checked ~ .frame .i1, .of-i .c1 { --c: #e3bb3c; }
#by-i:checked ~ .frame .i2, .of-i .c2 { --c: #e5772a; } #by-i:checked ~ .frame .i3, .of-i .c3 { --c: var(--none); }
.of-s .c0, .of-q .c0, .of-r .c0, #by-s:checked ~ .frame .s0, #by-q:checked ~ .frame .q0, #by-r:checked ~ .frame .r0 { --c: var(--none); }
.search { width: 100%; max-width: 24rem; font: inherit; padding: .4rem .7rem; border: 1px solid var(--line); border-radius: .4rem; background: var(--card); color: var(--ink); }
footer { margin-top: 4rem; padding-top: 1rem; border-top: 1px solid var(--line); color: var(--soft); font-size: .88rem; }
@media (max-width: 40rem) { body { padding: 1.3rem .9rem 3rem; } h1 { font-size: 1.55rem; } .facts { grid-template-columns: 1fr; gap: 0; } .facts dd { margin-bottom: .5rem; }
  .sum div { min-width: calc(50% - 1.4rem); padding: .5rem .8rem; } .sum i { display: none; }
  .sources tr { display: grid; grid-template-columns: 1fr auto; } .sources td.bar { grid-column: 1 / 3; grid-row: 2; width: auto; padding: 0 0 .4rem; } .sources thead { display: none; } }
@media print { body { max-width: none; padding: 0; font-size: 10pt; } nav, .zoom, .search { display: none; } h2 { break-after: avoid; } figure, .frame, .sum { break-inside: avoid; }
  a { color: inherit; text-decoration: none; } * { print-color-adjust: exact; -webkit-print-color-adjust: exact; } details::details-content { content-visibility: visible; block-size: auto; } }
)css";

const std::string_view kPageScript = R"js(
(function () {
  'use strict';
  const map = document.getElementById('map-svg');
  if (map) {
    const whole = map.viewBox.baseVal, full = [whole.x, whole.y, whole.width, whole.height];
    const bar = document.querySelector('.scale .bar'), text = document.querySelector('.scale .length');
    const metres = Number(map.dataset.metres);
    let view = full.slice();
    const show = function () {
      view[2] = Math.min(view[2], full[2]);
      view[3] = view[2] * full[3] / full[2];
      view[0] = Math.min(Math.max(view[0], full[0]), full[0] + full[2] - view[2]);
      view[1] = Math.min(Math.max(view[1], full[1]), full[1] + full[3] - view[3]);
      map.setAttribute('viewBox', view.join(' '));
      map.style.cursor = full[2] > view[2] ? 'grab' : '';
      map.style.touchAction = full[2] > view[2] ? 'none' : '';
      const width = metres * view[2] / full[2];
      let length = 1;
      for (let decade = 1; width / 5 >= decade; decade *= 10)
        for (const step of [1, 2, 5]) if (width / 5 >= decade * step) length = decade * step;
      bar.style.width = 100 * length / width + '%';
      text.textContent = length.toLocaleString('en') + '\u00a0m';
    };
    const zoom = function (factor, x, y) {
      const before = view[2];
      view[2] = Math.min(full[2], Math.max(full[2] / 400, view[2] / factor));
      const share = 1 - view[2] / before;
      view[0] += before * share * x;
      view[1] += before * full[3] / full[2] * share * y;
      show();
    };
    const buttons = document.createElement('div');
    buttons.className = 'zoom';
    for (const [label, title, act] of [['+', 'Closer', function () { zoom(1.6, 0.5, 0.5); }], ['\u2212', 'Further', function () { zoom(1 / 1.6, 0.5, 0.5); }],
                                       ['\u2922', 'Whole map', function () { view = full.slice(); show(); }]]) {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = label;
      button.title = title;
      button.addEventListener('click', act);
      buttons.append(button);
    }
    map.parentElement.append(buttons);
    map.addEventListener('wheel', function (event) {
      if (!event.ctrlKey) return;
      event.preventDefault();
      const box = map.getBoundingClientRect();
      zoom(event.deltaY > 0 ? 1 / 1.25 : 1.25, (event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    }, { passive: false });
    let from = null, moved = false;
    map.addEventListener('pointerdown', function (event) { from = [event.clientX, event.clientY, view[0], view[1]]; moved = false; });
    window.addEventListener('pointermove', function (event) {
      if (!from) return;
      const scale = view[2] / map.getBoundingClientRect().width, dx = event.clientX - from[0], dy = event.clientY - from[1];
      if (Math.abs(dx) + Math.abs(dy) > 4) moved = true;
      view[0] = from[2] - dx * scale;
      view[1] = from[3] - dy * scale;
      show();
    });
    window.addEventListener('pointerup', function () { from = null; });
    map.addEventListener('click', function (event) { if (moved) event.preventDefault(); }, true);
    map.addEventListener('dragstart', function (event) { event.preventDefault(); });
    window.addEventListener('hashchange', function () {
      if (location.hash.startsWith('#at-')) { view = full.slice(); show(); }
    });
  }
  const lists = Array.from(document.querySelectorAll('details.code'));
  if (lists.length > 0) {
    const input = document.createElement('input');
    input.type = 'search';
    input.className = 'search';
    input.placeholder = 'Search the lists: w123, a word';
    lists[0].parentElement.querySelector('.issues-lead').after(input);
    input.addEventListener('input', function () {
      const wanted = input.value.trim().toLowerCase();
      for (const list of lists) {
        let hits = 0;
        for (const item of list.querySelectorAll('li')) {
          const hit = item.textContent.toLowerCase().includes(wanted);
          item.hidden = !hit;
          if (hit) hits += 1;
        }
        list.hidden = wanted !== '' ? hits === 0 : false;
        list.open = wanted !== '' ? hits > 0 : false;
      }
    });
  }
})();
)js";

}  // namespace blockrand::outputs
