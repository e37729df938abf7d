"""A PostgreSQL of one's own in a temporary folder, reached by a unix socket, with PostGIS where it is installed."""
import glob
import os
import pwd
import shutil
import subprocess
import tempfile


def missing():
    """Why no server can be run here; None where one can."""
    if not programs():
        return 'PostgreSQL is not installed (Debian: postgresql, postgresql-15-postgis-3)'
    if not glob.glob('/usr/share/postgresql/*/extension/postgis.control'):
        return 'PostGIS is not installed (Debian: postgresql-15-postgis-3)'
    if os.geteuid() == 0:
        try:
            pwd.getpwnam('postgres')
        except KeyError:
            return 'PostgreSQL does not run as root, and there is no user postgres'
    return None


def programs():
    """Folder of initdb and postgres, the newest."""
    found = sorted(glob.glob('/usr/lib/postgresql/*/bin/initdb'), key=lambda p: int(p.split('/')[4]))
    return os.path.dirname(found[-1]) if found else None


class Server:
    """Started by start(), gone after stop(). Clients name it by `host`: a folder with its socket."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix='blockrand-pg-', dir='/tmp')
        self.host = os.path.join(self.folder, 'socket')
        os.makedirs(self.host)
        os.chmod(self.folder, 0o755)
        if os.geteuid() == 0:
            for path in (self.folder, self.host):
                shutil.chown(path, 'postgres')
        self.user = 'postgres'

    def run(self, *command):
        """As the user that PostgreSQL accepts."""
        prefix = ['setpriv', '--reuid=postgres', '--regid=postgres', '--clear-groups'] if os.geteuid() == 0 else []
        return subprocess.run([*prefix, *command], check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd='/')

    def start(self):
        data = os.path.join(self.folder, 'data')
        # Everybody must say the password, by any way: so that tests see where it goes.
        secret = os.path.join(self.folder, 'password')
        with open(secret, 'w', encoding='utf-8') as f:
            f.write('hush-hush')
        os.chmod(secret, 0o644)
        self.run(os.path.join(programs(), 'initdb'), '-D', data, '-U', self.user, '--auth=scram-sha-256', f'--pwfile={secret}',
                 '--encoding=UTF8', '--locale=C', '--no-sync')
        self.run(os.path.join(programs(), 'pg_ctl'), '-D', data, '-w', '-l', os.path.join(self.folder, 'log'), '-o',
                 f"-c listen_addresses='' -c unix_socket_directories='{self.host}' -c fsync=off", 'start')
        return self

    def stop(self):
        try:
            self.run(os.path.join(programs(), 'pg_ctl'), '-D', os.path.join(self.folder, 'data'), '-m', 'immediate', 'stop')
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)

    def connection(self, database):
        """As GDAL takes it, without the password, which comes by the environment."""
        return f'PG:dbname={database} host={self.host} user={self.user}'

    @property
    def environment(self):
        return {'PGPASSWORD': 'hush-hush'}

    def sql(self, database, statement):
        """Rows of a statement, as texts."""
        done = subprocess.run(['psql', '-h', self.host, '-U', self.user, '-d', database, '-X', '-A', '-t', '-F', '\x1f', '-R', '\x1e', '-v',
                               'ON_ERROR_STOP=1', '-c', statement], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              env=dict(os.environ, **self.environment))
        if done.returncode != 0:
            raise AssertionError(done.stderr.decode() + statement)
        text = done.stdout.decode().removesuffix('\n')
        return [row.split('\x1f') for row in text.split('\x1e')] if text else []

    def database(self, name, postgis=True):
        self.sql('postgres', f'CREATE DATABASE {name}')
        if postgis:
            self.sql(name, 'CREATE EXTENSION postgis')
        return self.connection(name)
