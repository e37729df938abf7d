// Proves that the committed bundle is what its sources make: builds it elsewhere and compares the bytes.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const made = mkdtempSync(join(tmpdir(), 'blockrand-viewer-'));
try {
  execFileSync(process.execPath, [join(here, 'build.mjs'), made], { stdio: 'inherit' });
  const kept = join(here, 'bundle');
  const differing = [...new Set([...readdirSync(made), ...readdirSync(kept)])].filter((name) => {
    try {
      return !readFileSync(join(made, name)).equals(readFileSync(join(kept, name)));
    } catch {
      return true;
    }
  });
  if (differing.length) {
    console.error(`differs from its sources: ${differing.join(', ')}; npm run build makes it anew`);
    process.exitCode = 1;
  } else console.log('the bundle is what its sources make');
} finally {
  rmSync(made, { recursive: true });
}
