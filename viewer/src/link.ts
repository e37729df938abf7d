// What a link to the page keeps, in its fragment: the chosen house and the colours. "#house=w123&colour=style"

export interface Kept {
  house: string | null;
  colour: string | null;
}

export function read_link(): Kept {
  const held = new URLSearchParams(location.hash.slice(1));
  const house = held.get('house');
  return { house: house && /^[\w.:-]{1,80}$/.test(house) ? house : null, colour: held.get('colour') };
}

export function write_link(kept: Kept): void {
  const parts = [
    kept.house ? `house=${encodeURIComponent(kept.house)}` : '',
    kept.colour && kept.colour !== 'built' ? `colour=${kept.colour}` : '',
  ];
  const fragment = parts.filter(Boolean).join('&');
  if (fragment === location.hash.slice(1)) return;
  // The fragment of a page opened from disk may not be replaced in some browsers.
  try {
    history.replaceState(null, '', fragment ? `#${fragment}` : location.pathname + location.search);
  } catch {
    location.hash = fragment;
  }
}
