"""`blockrand view`: what the server answers, what it refuses, and the same page as files.

The page itself runs in a browser in view_page_test.py.
"""
import contextlib
import gzip
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import threading
import time

from blockrand_run import SAMPLE, BuildTest, Setup, blockrand, files_of, main, read_json

PAGE = {'index.html', 'viewer.js', 'viewer.css', 'LICENSES.txt'}


class Answer:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body


def ask(port, target, method='GET', headers=()):
    """One request as it stands: no library may clean the path."""
    lines = [b'%s %s HTTP/1.1' % (method.encode(), target if isinstance(target, bytes) else target.encode())]
    given = dict(headers)
    if 'Host' not in given:
        lines.append(b'Host: 127.0.0.1:%d' % port)
    lines += [f'{k}: {v}'.encode() for k, v in given.items() if v is not None] + [b'Connection: close', b'', b'']
    with socket.create_connection(('127.0.0.1', port), timeout=30) as connection:
        connection.sendall(b'\r\n'.join(lines))
        got = b''
        while piece := connection.recv(1 << 16):
            got += piece
    head, _, body = got.partition(b'\r\n\r\n')
    first, *rest = head.decode('latin-1').split('\r\n')
    return Answer(int(first.split(' ')[1]), {k.lower(): v for k, v in (r.split(': ', 1) for r in rest)}, body)


@contextlib.contextmanager
def served(folder, *options):
    """The port of a server that runs meanwhile; it must end well when it is interrupted."""
    with subprocess.Popen([Setup.program, 'view', folder, '--log-format', 'json', *options], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)) as process:
        try:
            line = process.stdout.readline()
            yield int(re.search(r':(\d+)/', json.loads(line)['url']).group(1))
        finally:
            process.send_signal(signal.SIGINT)
            _, err = process.communicate(timeout=60)
        assert process.returncode == 0, err


class View(BuildTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.out = cls().build(SAMPLE, 'viewed', '--formats', 'gltf')
        cls.tiles = files_of(cls.out, '.glb')

    def test_the_page_finds_all_that_it_needs(self):
        with served(self.out) as port:
            page = ask(port, '/')
            self.assertEqual(page.status, 200)
            self.assertIn('text/html', page.headers['content-type'])
            for name in re.findall(rb'(?:src|href)="\.?/?([^":#]+)"', page.body):
                self.assertEqual(ask(port, b'/' + name).status, 200, name)
            view = json.loads(ask(port, '/view.json').body)
            self.assertEqual(view['name'], 'viewed')
            self.assertEqual(view['buildings'], read_json(self.out, 'build.json')['counts']['buildings'])
            self.assertIn('OpenStreetMap', view['attribution'])
            self.assertAlmostEqual(view['centre']['lon'], read_json(self.out, 'build.json')['region']['centre'][0], 2)
            for path in [view['tileset'], *view['places']]:
                self.assertEqual(ask(port, '/' + path).status, 200, path)
            self.assertTrue(view['places'])
            for tile in self.tiles:
                answer = ask(port, '/model/' + tile)
                with open(os.path.join(self.out, tile), 'rb') as file:
                    self.assertEqual(answer.body, file.read(), tile)
                self.assertEqual(answer.headers['content-type'], 'model/gltf-binary')

    def test_every_house_is_explained(self):
        with served(self.out) as port:
            view = json.loads(ask(port, '/view.json').body)
            houses = 0
            for name in files_of(os.path.join(self.out, 'explain'), '.jsonl.gz'):
                with gzip.open(os.path.join(self.out, 'explain', name), 'rt', encoding='utf-8') as file:
                    ids = [json.loads(line)['id'] for line in file]
                told = json.loads(ask(port, f'/{view["explained"]}{name[:-len(".jsonl.gz")]}.json').body)
                self.assertEqual(list(told), ids)
                for entry in told.values():
                    self.assertTrue(entry['title'])
                    self.assertTrue(entry['lines'])
                houses += len(ids)
            self.assertGreater(houses, 50)
            for tile in ['15_1_1', '..', 'index', '15_35206_25947.json', '']:
                self.assertEqual(ask(port, f'/explained/{tile}.json').status, 404, tile)

    def test_no_path_leads_out_of_the_build(self):
        place = os.path.join(self.folder, 'with_links')
        shutil.copytree(self.out, place)
        secret = os.path.join(self.folder, 'secret.txt')
        with open(secret, 'w', encoding='utf-8') as file:
            file.write('secret')
        os.symlink(secret, os.path.join(place, 'tiles', 'out.glb'))
        os.symlink(self.folder, os.path.join(place, 'tiles', 'up'))
        os.symlink('../tileset.json', os.path.join(place, 'tiles', 'within.json'))
        os.mkfifo(os.path.join(place, 'tiles', 'pipe.glb'))
        with served(place) as port:
            for target in ['/model/../secret.txt', '/../secret.txt', '/model/tiles/../../../secret.txt',
                           '/model/%2e%2e/secret.txt', '/model/%2e%2e%2fsecret.txt', '/model/tiles/..%2f..%2f..%2fsecret.txt',
                           '/model/..\\secret.txt', '/model/%5c..%5csecret.txt', '/model/tileset.json%00',
                           '/model/%00', '/model//tileset.json', '/model/./tileset.json', '/model/' + secret,
                           '/model//' + secret, '/' + secret, '/model/tiles/out.glb', '/model/tiles/up/secret.txt',
                           '/model/tiles', '/model/tiles/', '/model/', '/model/.hidden', '/model/tiles/pipe.glb',
                           '/model/%c0%ae%c0%ae/secret.txt', '/model/%252e%252e/secret.txt', '/nothing',
                           '/explained/../../secret.txt', '/explained/%2e%2e%2f%2e%2e%2fsecret.json']:
                answer = ask(port, target)
                self.assertEqual(answer.status, 404, target)
                self.assertNotIn(b'secret', answer.body, target)
            for target in [b'secret.txt', b'http://127.0.0.1/model/../secret.txt', b'*']:
                self.assertNotEqual(ask(port, target).status, 200, target)
            self.assertEqual(ask(port, '/model/tiles/within.json').status, 200)
            self.assertEqual(ask(port, '/view.json').status, 200, 'it serves on')

    def test_pages_from_elsewhere_are_refused(self):
        with served(self.out) as port:
            for headers in [{'Host': 'evil.example'}, {'Host': f'evil.example:{port}'}, {'Host': '127.0.0.1'},
                            {'Host': None}, {'Host': f'127.0.0.1:{port + 1}'}, {'Origin': 'http://evil.example'},
                            {'Origin': 'null'}, {'Origin': f'https://127.0.0.1:{port}'},
                            {'Origin': 'http://127.0.0.1:1'}, {'Sec-Fetch-Site': 'cross-site'},
                            {'Sec-Fetch-Site': 'same-site'}]:
                answer = ask(port, '/view.json', headers=headers)
                self.assertIn(answer.status, (400, 403), headers)
                self.assertNotIn(b'viewed', answer.body)
            for headers in [{'Host': f'localhost:{port}'}, {'Origin': f'http://127.0.0.1:{port}'},
                            {'Sec-Fetch-Site': 'same-origin'}, {'Sec-Fetch-Site': 'none'}]:
                self.assertEqual(ask(port, '/view.json', headers=headers).status, 200, headers)
            self.assertIn("default-src 'self'", ask(port, '/').headers['content-security-policy'])
            for method in ['POST', 'PUT', 'DELETE', 'PATCH', 'OPTIONS']:
                self.assertNotEqual(ask(port, '/view.json', method).status, 200, method)
            head = ask(port, '/model/tileset.json', 'HEAD')
            self.assertEqual((head.status, head.body), (200, b''))

    def test_only_this_machine_is_answered(self):
        others = {a[4][0] for a in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)} - {'127.0.0.1'}
        with served(self.out) as port:
            for address in others:
                with self.assertRaises(OSError):
                    socket.create_connection((address, port), timeout=5).close()

    def test_unchanged_files_are_not_sent_twice(self):
        with served(self.out) as port:
            path = '/model/' + self.tiles[0]
            first = ask(port, path)
            self.assertEqual(ask(port, path, headers={'If-None-Match': first.headers['etag']}).status, 304)
            self.assertEqual(ask(port, path, headers={'If-None-Match': '"other"'}).status, 200)
            size = len(first.body)
            for wanted in ['4-7', f'{size - 1}-{size + 300}', f'{size}-', '-0', '-']:
                piece = ask(port, path, headers={'Range': f'bytes={wanted}'})
                self.assertEqual((piece.status, piece.body), (200, first.body), wanted)

    def test_many_ask_at_once(self):
        with served(self.out) as port:
            wrong = []

            def work():
                for tile in self.tiles:
                    if len(ask(port, '/model/' + tile).body) != os.path.getsize(os.path.join(self.out, tile)):
                        wrong.append(tile)
            threads = [threading.Thread(target=work) for _ in range(12)]
            for t in threads:
                t.start()
            for t in threads:
                t.join()
            self.assertEqual(wrong, [])

    def test_the_browser_that_it_starts_is_served(self):
        tools = self.path('tools')
        os.makedirs(tools, exist_ok=True)
        with open(os.path.join(tools, 'xdg-open'), 'w', encoding='utf-8') as file:
            file.write('#!/bin/sh\ngrep SigBlk /proc/self/status > "$BROWSER_SAW"\n'
                       'python3 -c "import sys, urllib.request; print(len(urllib.request.urlopen(sys.argv[1]).read()))" "$1" >> "$BROWSER_SAW"\n')
        os.chmod(os.path.join(tools, 'xdg-open'), 0o755)
        saw = self.path('saw.txt')
        os.environ.update(BROWSER_SAW=saw, PATH=tools + ':' + os.environ['PATH'])
        with served(self.out, '--open'):
            for _ in range(100):
                if os.path.exists(saw) and len(open(saw, encoding='utf-8').read().split()) == 3:
                    break
                time.sleep(0.1)
            name, blocked, size = open(saw, encoding='utf-8').read().split()
        self.assertEqual(int(blocked, 16), 0, 'it can be ended')
        self.assertGreater(int(size), 100)

    def test_it_ends_while_clients_hold_it(self):
        with served(self.out) as port:
            held = [socket.create_connection(('127.0.0.1', port)) for _ in range(40)]
            for connection in held:
                connection.sendall(b'GET /view.json HTTP/1.1\r\nHost: ')
            began = time.monotonic()
        self.assertLess(time.monotonic() - began, 30)
        for connection in held:
            connection.close()

    def test_ports(self):
        with served(self.out) as port:
            taken = blockrand('view', self.out, '--port', port)
            self.assertEqual(taken.code, 1)
            self.assertIn(f'--port {port} is taken', taken.err)
            with served(self.out) as another:
                self.assertNotEqual(port, another)
        for wrong in ['-1', '65536', 'x']:
            self.assertEqual(blockrand('view', self.out, '--port', wrong).code, 1)

    def test_what_is_no_build_is_told(self):
        for folder, words in [(os.path.join(self.folder, 'nowhere'), 'does not exist'), (SAMPLE, 'is a file'),
                              (self.folder, 'no finished build')]:
            run = blockrand('view', folder)
            self.assertEqual(run.code, 1, run)
            self.assertIn(words, run.err)
        bare = self.build(SAMPLE, 'bare', '--formats', 'citygml')
        run = blockrand('view', bare)
        self.assertEqual(run.code, 1)
        self.assertIn('no 3D Tiles', run.err)
        damaged = os.path.join(self.folder, 'damaged')
        shutil.copytree(self.out, damaged)
        with open(os.path.join(damaged, 'tileset.json'), 'w', encoding='utf-8') as file:
            file.write('{"root":')
        run = blockrand('view', damaged)
        self.assertEqual(run.code, 2, run)
        self.assertIn('tileset.json', run.err)

    def test_a_region_shows_what_it_publishes(self):
        region = os.path.join(self.folder, 'region')
        os.makedirs(region)
        with open(os.path.join(region, 'region.toml'), 'w', encoding='utf-8') as file:
            file.write('[build]\nlod = 2\nformats = ["gltf"]\n')
        self.assertEqual(blockrand('update', region, SAMPLE).code, 0)
        with served(region) as port:
            view = json.loads(ask(port, '/view.json').body)
            self.assertEqual(view['name'], 'region')
            self.assertEqual(ask(port, '/' + view['tileset']).status, 200)
            for hidden in ['/model/region.toml', '/model/../region.toml', '/model/current/tileset.json', '/model/tileset.json',
                           '/model/000009/tileset.json', '/model/000001', '/model/000001/', '/model/000001/../../region.toml']:
                self.assertEqual(ask(port, hidden).status, 404, hidden)
            # What is published meanwhile does not get into a page that is open.
            with open(os.path.join(region, 'region.toml'), 'w', encoding='utf-8') as file:
                file.write('[build]\nlod = 1\nformats = ["gltf"]\n')
            self.assertEqual(blockrand('update', region).code, 0)
            newer = json.loads(ask(port, '/view.json').body)
            self.assertNotEqual(newer['tileset'], view['tileset'])
            self.assertEqual((view['lod'], newer['lod']), (2, 1))
            for name in files_of(os.path.join(region, 'builds', '000001'), '.glb'):
                self.assertEqual(ask(port, '/model/000001/' + name).status, 200)
            tile = files_of(os.path.join(region, 'builds', '000001', 'explain'), '.jsonl.gz')[0][:-len('.jsonl.gz')]
            self.assertEqual(ask(port, f'/{view["explained"]}{tile}.json').status, 200)

    def test_an_export_is_the_same_site(self):
        site = os.path.join(self.folder, 'site')
        run = blockrand('view', self.out, '--export', site)
        self.assertEqual(run.code, 0, run)
        files = files_of(site)
        self.assertLess(PAGE, set(files))
        with served(self.out) as port:
            for path in files:
                if path == 'files.txt':
                    continue
                with open(os.path.join(site, path), 'rb') as file:
                    self.assertEqual(ask(port, '/' + path).body, file.read(), path)
        self.assertEqual([f for f in files if f.endswith('.glb')], ['model/' + t for t in self.tiles])
        self.assertFalse([f for f in files if f.endswith(('.gml', '.gpkg', '.gz'))], 'nothing that no page asks for')
        again = blockrand('view', self.out, '--export', site)
        self.assertEqual(again.code, 1)
        self.assertEqual(blockrand('view', self.out, '--export', site, '--force').code, 0)
        self.assertEqual(files_of(site), files)
        with open(os.path.join(site, 'notes.txt'), 'w', encoding='utf-8') as file:
            file.write('mine')
        kept = blockrand('view', self.out, '--export', site, '--force')
        self.assertEqual(kept.code, 1, kept)
        self.assertIn('notes.txt', kept.err)
        self.assertTrue(os.path.exists(os.path.join(site, 'notes.txt')))
        for options in [['--export', site, '--open'], ['--force']]:
            self.assertEqual(blockrand('view', self.out, *options).code, 1, options)
        for place in [os.path.join(self.out, 'site'), os.path.join(self.out, 'tiles', 'deep', 'site'), self.out]:
            inside = blockrand('view', self.out, '--export', place, '--force')
            self.assertEqual(inside.code, 1, inside)
        self.assertEqual(blockrand('validate', self.out).code, 0)

    def test_areas_are_one_site(self):
        areas = self.build(SAMPLE, 'areas', '--areas', '14', '--formats', 'gltf')
        site = os.path.join(self.folder, 'areas_site')
        self.assertEqual(blockrand('view', areas, '--export', site).code, 0)
        view = read_json(site, 'view.json')
        self.assertGreater(len(view['places']), 1)
        houses = 0
        for path in view['places']:
            with open(os.path.join(site, path), encoding='utf-8') as file:
                rows = [line.rstrip('\n').split('\t') for line in file]
            for row in rows:
                self.assertIn(row[0], read_json(site, view['explained'], row[1] + '.json'))
            houses += len(rows)
        whole = os.path.join(self.out, 'explain', 'places.tsv')
        with open(whole, encoding='utf-8') as file:
            self.assertEqual(houses, len(file.readlines()))


if __name__ == '__main__':
    main()
