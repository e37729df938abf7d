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
