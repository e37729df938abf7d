"""A web server over a folder, and a reader that walks its tileset to all contents, again and again."""
import contextlib
import functools
import http.client
import http.server
import json
import posixpath
import struct
import threading


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@contextlib.contextmanager
def web_server(folder):
    """\\yields its port on 127.0.0.1"""
    server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), functools.partial(Quiet, directory=folder))
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


def contents_of(tile):
    for content in [tile.get('content')] + tile.get('contents', []):
        if content:
            yield content['uri']
    for child in tile.get('children', []):
        yield from contents_of(child)


class Reader:
    """Follows every link as a viewer does. What is wrong is noted in `problems`."""

    def __init__(self, port, root=''):
        self.port, self.root, self.problems, self.walks, self.files = port, root, [], 0, 0

    def get(self, connection, path, whence):
        try:
            connection.request('GET', '/' + self.root + path)
            answer = connection.getresponse()
            body = answer.read()
        except (http.client.HTTPException, OSError) as error:
            connection.close()
            self.problems.append(f'{path}: {error!r}')
            return None
        self.files += 1
        if answer.status != 200:
            self.problems.append(f'{path}: {answer.status}, named by {whence}')
            return None
        return body

    def walk(self):
        """From tileset.json to all tilesets, tiles and textures."""
        connection = http.client.HTTPConnection('127.0.0.1', self.port, timeout=30)
        waiting, seen = [('tileset.json', 'nobody')], set()
        while waiting:
            path, whence = waiting.pop()
            if path in seen:
                continue
            seen.add(path)
            body = self.get(connection, path, whence)
            if body is None:
                continue
            for uri in self.links(path, body):
                if not uri.startswith('data:'):
                    waiting.append((posixpath.normpath(posixpath.join(posixpath.dirname(path), uri)), path))
        connection.close()
        self.walks += 1
        return seen

    def links(self, path, body):
        """What a file leads to; a half one is a problem."""
        if path.endswith('.json'):
            try:
                return list(contents_of(json.loads(body)['root']))
            except ValueError:
                self.problems.append(f'{path}: half a file')
        if path.endswith('.glb'):
            if len(body) < 20 or struct.unpack('<4sII', body[:12]) != (b'glTF', 2, len(body)):
                self.problems.append(f'{path}: half a file')
                return []
            gltf = json.loads(body[20:20 + struct.unpack('<I', body[12:16])[0]])
            return [x['uri'] for x in gltf.get('images', []) + gltf.get('buffers', []) if 'uri' in x]
        return []


@contextlib.contextmanager
def reading(port, root=''):
    """A reader that walks all the time, in a thread of its own."""
    reader, end = Reader(port, root), threading.Event()

    def loop():
        while not end.is_set():
            reader.walk()
    thread = threading.Thread(target=loop)
    thread.start()
    try:
        yield reader
    finally:
        end.set()
        thread.join()
