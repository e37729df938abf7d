// Khronos validator over GLB files and folders.
//   node validate_gltf.mjs [--warnings-are-errors] PATH...
// One line per error or warning, one summary line at the end; exit 1 on any error, 2 when there is nothing to check.
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { files_below } from './glb.mjs';

// Resolved from the working directory as well, so that node_modules may live outside the source tree.
const load = (name) => {
  for (const base of [import.meta.url, `file://${process.cwd()}/`]) {
    try {
      return createRequire(base)(name);
    } catch (error) {
      if (error.code !== 'MODULE_NOT_FOUND') throw error;
    }
  }
  console.error(`${name} is not installed: run npm install with tests/validators/package.json`);
  process.exit(2);
};
const validator = load('gltf-validator');

const args = process.argv.slice(2);
const strict = args.includes('--warnings-are-errors');
const files = args.filter((a) => !a.startsWith('--')).flatMap((a) => files_below(a, ['.glb', '.gltf']));
if (files.length === 0) {
  console.error('no .glb file found');
  process.exit(2);
}

// Extensions that the validator does not know are judged by check_metadata.mjs.
const ignoredIssues = ['UNSUPPORTED_EXTENSION', 'UNUSED_OBJECT'];
const total = { errors: 0, warnings: 0 };
for (const file of files) {
  let report;
  try {
    report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
      uri: file,
      ignoredIssues,
      maxIssues: 50,
      externalResourceFunction: async (uri) => new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri)))),
    });
  } catch (error) {
    console.log(`${file}: error: ${error}`);
    ++total.errors;
    continue;
  }
  total.errors += report.issues.numErrors;
  total.warnings += report.issues.numWarnings;
  for (const m of report.issues.messages)
    if (m.severity < 2) console.log(`${file}: ${m.severity === 0 ? 'error' : 'warning'}: ${m.code} ${m.pointer ?? ''} ${m.message}`);
}
console.log(`gltf-validator: ${files.length} files, ${total.errors} errors, ${total.warnings} warnings`);
process.exit(total.errors > 0 || (strict && total.warnings > 0) ? 1 : 0);
