// Manifests against the schemas of Kubernetes, as the package kubernetes-models has them.
//   node check_kubernetes.mjs NODE_MODULES FILE.yaml > JSON
// Prints [{"kind", "name", "errors": [...]}] and the parsed documents; exit code 1 where one is wrong.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const [modules, file] = process.argv.slice(2);
const require = createRequire(path.join(path.resolve(modules), 'nothing.js'));
const yaml = require('js-yaml');

// Types of the declarations beside the schemas: the schemas themselves let unknown fields pass, which the server drops.
const schemas = path.join(path.resolve(modules), 'kubernetes-models');
const kinds = { CronJob: 'batch/v1', ConfigMap: 'v1', PersistentVolumeClaim: 'v1', Job: 'batch/v1' };

function declaration(id) {
  const at = path.join(schemas, ...id.split('/')) + '.d.ts';
  return fs.existsSync(at) ? fs.readFileSync(at, 'utf8') : '';
}

/// Fields of a declared type, each with the type that its declaration refers to. Null where nothing is declared.
function fieldsOf(file) {
  const text = declaration(file);
  const body = /export interface \w+[^{]*\{([\s\S]*?)\n\}/.exec(text)?.[1];
  if (body === undefined) return null;
  const imports = new Map([...text.matchAll(/import \{ (\w+)(?: as (\w+))? \} from "([^"]+)"/g)].map((m) => [m[2] ?? m[1], m[3]]));
  const fields = new Map();
  for (const m of body.matchAll(/^    "?([\w$]+)"?\??: ([^;]+);/gm)) fields.set(m[1], imports.get(/\w+/.exec(m[2].replace('Array<', ''))[0]) ?? null);
  return { fields, folder: path.dirname(file) };
}

function unknown(value, file, where, errors) {
  const known = fieldsOf(file);
  if (!known || value === null || typeof value !== 'object') return;
  for (const [key, inside] of Object.entries(value)) {
    if (!known.fields.has(key)) { errors.push(`${where}.${key}: no such field`); continue; }
    const type = known.fields.get(key);
    if (!type || !type.startsWith('.')) continue;
    const next = path.posix.join(known.folder, type);
    for (const one of Array.isArray(inside) ? inside : [inside]) unknown(one, next, `${where}.${key}`, errors);
  }
}

let wrong = false;
const documents = yaml.loadAll(fs.readFileSync(file, 'utf8'));
const checked = documents.map((document) => {
  const errors = [];
  if (kinds[document?.kind] !== document?.apiVersion) {
    errors.push(`no kind that is known: ${document?.apiVersion} ${document?.kind}`);
  } else {
    const id = `${document.apiVersion}/${document.kind}`;
    const Model = require(`kubernetes-models/${id}`)[document.kind];
    try { new Model(document).validate(); } catch (error) { errors.push(String(error.message)); }
    unknown(document, id, document.kind, errors);
  }
  wrong ||= errors.length > 0;
  return { kind: document?.kind, name: document?.metadata?.name, errors };
});
console.log(JSON.stringify({ checked, documents }));
process.exit(wrong ? 1 : 0);
