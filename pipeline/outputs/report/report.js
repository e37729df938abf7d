
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
