(function () {
  'use strict';
  // Neither the sign of "less" nor that of "and" stands in this file: the page is XML as well.
  const element = function (name, properties, children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...(children || []).filter(function (c) { return c !== ''; }));
    return made;
  };
  const thousands = function (n) { return Math.round(n).toLocaleString('en'); };

  // ---- The houses that the page knows.
  const data = document.getElementById('house-data');
  const known = data ? JSON.parse(data.textContent) : { houses: [] };
  const ID = 0, ADDRESS = 1, NAME = 2, USE = 3, STOREYS = 4, STOREYS_FROM = 5, HEIGHT = 6, HEIGHT_FROM = 7, ROOF = 8, ROOF_FROM = 9,
    STYLE = 10, STYLE_FROM = 11, ERA = 12, AREA = 13, ROOF_AREA = 14, BLOCK = 15, X = 16, Y = 17;
  const houses = known.houses, by_id = new Map(houses.map(function (h) { return [h[ID], h]; }));
  // As people write: without accents, with any spelling of "street".
  const folded = function (text) {
    return text.toLowerCase().normalize('NFD').replace(/\p{M}/gu, '').replaceAll('\u00df', 'ss').replace(/str(asse|\.)/g, 'str');
  };
  const texts = houses.map(function (h) { return folded(h[ID] + ' ' + h[ADDRESS] + ' ' + h[NAME] + ' ' + known.uses[h[USE]]); });
  const is_built = function (h) { return h[STOREYS] >= 0; };
  const page_of = function (id) {
    return id[1] === '-' ? '' : 'https://www.openstreetmap.org/' + { n: 'node', w: 'way', r: 'relation' }[id[0]] + '/' + id.slice(1);
  };

  // ---- The map: zoom, drag, and the house that is chosen.
  const map = document.getElementById('map-svg');
  let show_at = function () {}, choose = function () {}, table_find = function () {};
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
    show_at = function (x, y) {
      view[2] = Math.min(view[2], full[2] * 300 / metres);
      view[3] = view[2] * full[3] / full[2];
      view[0] = x - view[2] / 2;
      view[1] = y - view[3] / 2;
      show();
    };
    const sheet = map.parentElement, frame = sheet.parentElement;
    const buttons = element('div', { className: 'zoom' });
    for (const [label, title, act] of [['+', 'Closer', function () { zoom(1.6, 0.5, 0.5); }], ['\u2212', 'Further', function () { zoom(1 / 1.6, 0.5, 0.5); }],
                                       ['\u2922', 'Whole map', function () { view = full.slice(); show(); }]]) {
      const button = element('button', { type: 'button', textContent: label, title: title });
      button.setAttribute('aria-label', title);
      button.addEventListener('click', act);
      buttons.append(button);
    }
    sheet.append(buttons);
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
    map.addEventListener('dragstart', function (event) { event.preventDefault(); });

    const card = element('div', { className: 'house-card', id: 'house-card', hidden: true });
    card.setAttribute('role', 'status');
    frame.append(card);
    const ring = document.createElementNS('http://www.w3.org/2000/svg', 'circle');
    ring.setAttribute('class', 'ring');
    ring.setAttribute('r', full[2] * 9 / metres);
    map.append(ring);
    let chosen = null, outline = null;
    const close = function () {
      card.hidden = true;
      ring.removeAttribute('cx');
      ring.classList.remove('on');
      if (outline) outline.classList.remove('chosen');
      chosen = outline = null;
    };
    choose = function (house, go) {
      close();
      chosen = house;
      outline = document.getElementById(house[ID]);
      if (outline) outline.classList.add('chosen');
      const facts = [];
      const fact = function (name, value, source) {
        if (value === '') return;
        const dd = element('dd', {}, [value]);
        if (source !== undefined) dd.append(' ', element('span', { className: 'soft', textContent: known.sources[source] }));
        facts.push(element('dt', { textContent: name }), dd);
      };
      const page = page_of(house[ID]);
      fact('Id', page ? element('a', { href: page, textContent: house[ID] }) : house[ID]);
      fact('Use', known.uses[house[USE]]);
      if (is_built(house)) {
        fact('Storeys', String(house[STOREYS]), house[STOREYS_FROM]);
        fact('Height', house[HEIGHT] + '\u00a0m', house[HEIGHT_FROM]);
        fact('Roof', known.roofs[house[ROOF]], house[ROOF_FROM]);
      } else {
        fact('Body', 'not built');
      }
      if (house[STYLE] >= 0) fact('Style', known.styles[house[STYLE]], house[STYLE_FROM]);
      if (house[ERA] >= 0) fact('Era', known.eras[house[ERA]]);
      fact('Floor area', thousands(house[AREA]) + '\u00a0m\u00b2' + (house[ROOF_AREA] > 0 ? ', in the roof ' + thousands(house[ROOF_AREA]) + '\u00a0m\u00b2' : ''));
      if (house[BLOCK] > 0) {
        const shown = document.getElementById('block-' + house[BLOCK]);
        fact('Block', shown ? element('a', { href: '#block-' + house[BLOCK], textContent: String(house[BLOCK]) }) : String(house[BLOCK]));
      }
      const dismiss = element('button', { type: 'button', className: 'close', textContent: '\u00d7' });
      dismiss.setAttribute('aria-label', 'Close');
      dismiss.addEventListener('click', function () { close(); frame.focus(); });
      const row = element('button', { type: 'button', className: 'link', textContent: 'Show it in the table' });
      row.addEventListener('click', function () { table_find(house[ID]); });
      card.replaceChildren(dismiss, element('h3', { textContent: house[ADDRESS] || house[NAME] || house[ID] }),
                           house[NAME] ? element('p', { className: 'soft', textContent: house[ADDRESS] ? house[NAME] : '' }) : '',
                           element('dl', {}, facts), row);
      card.hidden = false;
      if (house[X] === undefined) return;
      ring.setAttribute('cx', house[X]);
      ring.setAttribute('cy', house[Y]);
      ring.classList.add('on');
      if (!go) return;
      show_at(house[X], house[Y]);
      frame.scrollIntoView({ block: 'center' });
    };
    /// The house nearest to a place of the map, at most `within` units away; `fits` may refuse.
    const nearest = function (x, y, within, fits) {
      let best = null, least = within;
      for (const house of houses) {
        if (house[X] === undefined) continue;
        const dx = house[X] - x, dy = house[Y] - y, far = Math.hypot(dx, dy);
        if (least > far) if (fits(house, dx, dy)) { best = house; least = far; }
      }
      return best;
    };
    map.addEventListener('click', function (event) {
      if (moved) return;
      const direct = by_id.get(event.target.id);
      if (direct) { choose(direct, false); return; }
      if (document.querySelector('.footprints path[id]')) { close(); return; }
      const box = map.getBoundingClientRect();
      const x = view[0] + (event.clientX - box.left) / box.width * view[2], y = view[1] + (event.clientY - box.top) / box.height * view[3];
      const near = nearest(x, y, full[2] * 25 / metres, function () { return true; });
      if (near) choose(near, false); else close();
    });
    if (houses.length > 0) {
      frame.tabIndex = 0;
      frame.setAttribute('role', 'group');
      frame.setAttribute('aria-label', 'Map. The arrow keys lead from house to house.');
      frame.addEventListener('keydown', function (event) {
        if (event.key === 'Escape') close();
        const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }, way = ways[event.key];
        if (!way) return;
        event.preventDefault();
        const x = chosen ? chosen[X] : view[0] + view[2] / 2, y = chosen ? chosen[Y] : view[1] + view[3] / 2;
        const next = nearest(x, y, Infinity, function (house, dx, dy) {
          const ahead = dx * way[0] + dy * way[1], aside = Math.abs(dx * way[1]) + Math.abs(dy * way[0]);
          return house === chosen ? false : chosen ? ahead > aside : true;
        });
        if (!next) return;
        choose(next, false);
        const inside = next[X] > view[0] ? view[0] + view[2] > next[X] ? next[Y] > view[1] ? view[1] + view[3] > next[Y] : false : false : false;
        if (!inside) show_at(next[X], next[Y]);
      });
    }
    const go_to_hash = function () {
      const name = decodeURIComponent(location.hash.slice(1));
      if (by_id.has(name)) choose(by_id.get(name), true);
      if (name.startsWith('at-')) { view = full.slice(); show(); }
      const block = name.startsWith('block-') ? document.getElementById(name) : null;
      if (!block) return;
      const box = block.getBBox();
      view[2] = Math.min(full[2], Math.max(box.width, box.height * full[2] / full[3]) * 1.6);
      view[3] = view[2] * full[3] / full[2];
      view[0] = box.x + box.width / 2 - view[2] / 2;
      view[1] = box.y + box.height / 2 - view[3] / 2;
      show();
      frame.scrollIntoView({ block: 'center' });
    };
    window.addEventListener('hashchange', go_to_hash);
    if (location.hash) go_to_hash();
  }

  // ---- Tables: a button in each heading sorts.
  const number_in = function (text) {
    const n = parseFloat(text.replace(/[,\u003c\u003e\u00a0]/g, ''));
    return isNaN(n) ? -Infinity : n;
  };
  const add_sorting = function (table, sort) {
    const heads = Array.from(table.querySelectorAll('thead th'));
    heads.forEach(function (head, column) {
      const button = element('button', { type: 'button', className: 'sort' });
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener('click', function () {
        // Numbers begin with the largest.
        const numeric = head.classList.contains('n'), before = head.getAttribute('aria-sort');
        const down = before === null ? numeric : before === 'ascending';
        for (const other of heads) other.removeAttribute('aria-sort');
        head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
        sort(column, numeric, down);
      });
    });
  };
  for (const table of document.querySelectorAll('table.sortable')) {
    const body = table.tBodies[0];
    add_sorting(table, function (column, numeric, down) {
      const rows = Array.from(body.rows).map(function (row) { return [row, row.cells[column].textContent]; });
      rows.sort(function (a, b) {
        const order = numeric ? number_in(a[1]) - number_in(b[1]) || 0 : a[1].localeCompare(b[1], 'en', { numeric: true });
        return down ? -order : order;
      });
      body.append(...rows.map(function (r) { return r[0]; }));
    });
  }

  // ---- The table of houses, and the search.
  const table = document.getElementById('house-table');
  if (table) {
    const STEP = 25, body = table.tBodies[0], note = element('p', { className: 'small soft', id: 'house-count' });
    note.setAttribute('role', 'status');
    const more = element('button', { type: 'button', className: 'more', textContent: 'Show ' + STEP + ' more' });
    const before = document.getElementById('house-note');
    if (before) before.remove();
    table.parentElement.after(note, more);
    let order = houses.map(function (h, i) { return i; }), found = order, rows = STEP;
    const row_of = function (house) {
      const jump = element('button', { type: 'button', className: 'link', textContent: house[ID] });
      jump.addEventListener('click', function () { choose(house, true); });
      const name = house[NAME] ? element('span', { className: 'soft', textContent: (house[ADDRESS] ? ' ' : '') + house[NAME] }) : '';
      const cell = function (text, numeric) { return element('td', { className: numeric ? 'n' : '', textContent: text }); };
      const row = element('tr', { id: 'house-' + house[ID] }, [element('td', {}, [jump]), element('td', {}, [house[ADDRESS], name]), cell(known.uses[house[USE]])]);
      if (is_built(house))
        row.append(cell(house[STOREYS], true), cell(known.sources[house[STOREYS_FROM]]), cell(house[HEIGHT].toFixed(1) + '\u00a0m', true), cell(known.roofs[house[ROOF]]));
      else
        row.append(cell('\u2013', true), cell('not built'), cell('\u2013', true), cell(''));
      row.append(cell(house[STYLE] >= 0 ? known.styles[house[STYLE]] : ''), cell(house[ERA] >= 0 ? known.eras[house[ERA]] : ''),
                 cell(is_built(house) ? thousands(house[AREA]) + '\u00a0m\u00b2' : '', true));
      return row;
    };
    const draw = function () {
      body.replaceChildren(...found.slice(0, rows).map(function (i) { return row_of(houses[i]); }));
      const shown = Math.min(rows, found.length);
      note.textContent = found.length === 0 ? 'No house of this id, address, name or use.'
        : thousands(shown) + ' of ' + thousands(found.length) + (found.length === houses.length ? ' houses' : ' houses found') + ' shown.';
      more.hidden = shown === found.length;
    };
    more.addEventListener('click', function () { rows += STEP; draw(); });
    // By column: the value that sorts, a number or a text.
    const values = [function (h) { return h[ID]; }, function (h) { return h[ADDRESS] || '\uffff' + h[NAME]; }, function (h) { return known.uses[h[USE]]; },
      function (h) { return h[STOREYS]; }, function (h) { return known.sources[h[STOREYS_FROM]]; }, function (h) { return h[HEIGHT]; },
      function (h) { return known.roofs[h[ROOF]]; }, function (h) { return h[STYLE] >= 0 ? known.styles[h[STYLE]] : ''; },
      function (h) { return h[ERA]; }, function (h) { return h[AREA]; }];
    const collator = new Intl.Collator('en', { numeric: true });
    let matches = function () { return true; };
    const filter = function () { found = order.filter(matches); rows = STEP; draw(); };
    add_sorting(table, function (column, numeric, down) {
      const keys = houses.map(values[column]), by_number = typeof keys[0] === 'number';
      order.sort(function (a, b) {
        const first = by_number ? keys[a] - keys[b] : collator.compare(keys[a], keys[b]);
        return (down ? -first : first) || a - b;
      });
      filter();
    });

    const input = element('input', { type: 'search', className: 'search', id: 'house-search', placeholder: 'w123, Allee 12, school' });
    input.setAttribute('autocomplete', 'off');
    const hits = element('ul', { className: 'hits', id: 'house-hits' });
    const status = element('span', { className: 'small soft', id: 'house-found' });
    status.setAttribute('role', 'status');
    const search = element('div', { className: 'finder' },
      [element('label', { htmlFor: 'house-search', textContent: 'Find a house by id, address, name or use' }), input, status, hits]);
    const place = document.querySelector('.themes');
    if (place) place.before(search); else table.parentElement.before(search);
    const HITS = 8;
    const look = function () {
      const words = folded(input.value).split(/[\s,]+/).filter(function (w) { return w !== ''; });
      matches = words.length === 0 ? function () { return true; } : function (i) { return words.every(function (w) { return texts[i].includes(w); }); };
      filter();
      hits.replaceChildren();
      status.textContent = '';
      if (words.length === 0) return;
      // The id itself comes first.
      const first = found.slice().sort(function (a, b) { return (houses[b][ID] === words[0] ? 1 : 0) - (houses[a][ID] === words[0] ? 1 : 0); });
      for (const i of first.slice(0, HITS)) {
        const h = houses[i];
        const go = element('button', { type: 'button' }, [element('b', { textContent: h[ADDRESS] || h[NAME] || h[ID] }),
          element('span', { className: 'soft', textContent: [h[ADDRESS] ? h[NAME] : '', known.uses[h[USE]], h[ID]].filter(Boolean).join(', ') })]);
        go.addEventListener('click', function () { choose(h, true); });
        hits.append(element('li', {}, [go]));
      }
      status.textContent = found.length === 0 ? 'None found.' : found.length > HITS ? thousands(found.length) + ' found; all are in the table.' : '';
    };
    input.addEventListener('input', look);
    input.addEventListener('keydown', function (event) {
      const first = hits.querySelector('button');
      if (event.key === 'Enter') if (first) first.click();
    });
    table_find = function (id) {
      input.value = id;
      look();
      const row = document.getElementById('house-' + id);
      if (row) { row.classList.add('chosen'); row.scrollIntoView({ block: 'center' }); row.querySelector('button').focus({ preventScroll: true }); }
    };
    draw();
  }

  // ---- The lists of issues.
  const lists = Array.from(document.querySelectorAll('details.code'));
  if (lists.length > 0) {
    const input = element('input', { type: 'search', className: 'search', placeholder: 'Search the lists: w123, a word' });
    input.setAttribute('aria-label', 'Search the lists');
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
