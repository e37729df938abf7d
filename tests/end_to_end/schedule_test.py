"""Nights by systemd, cron, Slurm and Kubernetes, and what a run tells Prometheus and its operator.

What judges the files (systemd-analyze, promtool, Slurm, schemas of Kubernetes) is optional: a test without its judge says
"not checked: X is not installed", and checks what it can."""
import glob
import json
import os
import re
import shutil
import socket
import subprocess
import time
import unittest

from blockrand_run import SAMPLE, SOURCE, Setup, blockrand, call, main, read_json
from osm_files import Node, write_xml
from region_run import RegionTest

VALIDATORS = os.path.join(SOURCE, 'tests', 'validators')


def judge(tool):
    """Whether a program is there; says so where it is not."""
    if shutil.which(tool):
        return True
    print(f'not checked: {tool} is not installed')
    return False


def files_in(out):
    """The files that `schedule` printed, by name."""
    parts = re.split(r'^# FILE (.+)\n', out, flags=re.M)
    return dict(zip(parts[1::2], parts[2::2]))


def samples(folder):
    """{(name, labels): value} of log/metrics.prom."""
    found = {}
    with open(os.path.join(folder, 'log', 'metrics.prom'), encoding='utf-8') as f:
        for line in f:
            if not line.startswith('#'):
                name, labels, value = re.fullmatch(r'(\w+)\{(.*)\} (\S+)\n', line).groups()
                found[name, tuple(re.findall(r'(\w+)="((?:[^"\\]|\\.)*)"', labels)[1:])] = float(value)
    return found


class Schedules(RegionTest):
    ODD = "it's 100% \"odd\" $HOME Köln"

    def schedule(self, folder, kind, *arguments, code=0, **how):
        run = blockrand('schedule', folder, '--print', kind, *arguments, **how)
        self.assertEqual(run.code, code, run)
        return run

    def program_in(self, folder):
        """A copy of the program below a path with an odd name, with its configs."""
        os.makedirs(folder)
        program = os.path.join(folder, 'blockrand')
        shutil.copy(Setup.program, program)
        os.symlink(os.path.join(SOURCE, 'configs'), os.path.join(folder, 'configs'))
        return program

    def test_wrong_usage(self):
        folder = self.region('usage')
        self.refused(blockrand('schedule', folder), 1, '--print')
        self.refused(self.schedule(folder, 'cron', '--at', '25:00', code=1), 1, '02:30')
        self.refused(self.schedule(folder, 'cron', '--shards', '3', code=1), 1, 'shards')
        self.refused(self.schedule(folder, 'anacron', code=1), 1, 'systemd')
        self.refused(self.schedule(self.path('nowhere'), 'cron', code=1), 1, 'no region yet')
        self.refused(self.schedule(self.region('new\nline'), 'cron', code=1), 1, 'control character')
        self.refused(self.schedule(self.region('a\\%b'), 'cron', code=1), 1, 'crontab')
        self.refused(self.schedule(self.region('space '), 'systemd', code=1, cwd=self.region('space ')), 1, 'systemd')
        self.refused(self.schedule(folder, 'kubernetes', '--shards', '3', '--notify', 'x', code=1), 1, 'shards')

    def test_systemd(self):
        for name in ('town', 'two words 100% $HOME Köln', self.ODD):
            with self.subTest(name):
                folder = self.region(name)
                program = self.program_in(self.path('bin ' + name))
                units = self.path('units ' + name)
                os.makedirs(units)
                run = call([program, 'schedule', folder, '--print', 'systemd', '--at', '04:05', '--user', 'daemon', '--notify',
                            'echo "$BLOCKRAND_REASON" 50%', '--max-age', '30', '--into', units])
                self.assertEqual(run.code, 0, run)
                paths = run.out.splitlines()
                self.assertEqual(sorted(paths), sorted(glob.glob(os.path.join(glob.escape(units), '*'))))
                self.assertEqual([os.path.splitext(p)[1] for p in paths], ['.service', '.timer', '.service'])
                text = {p: open(p, encoding='utf-8').read() for p in paths}
                self.assertIn('OnCalendar=*-*-* 04:05:00\n', text[paths[1]])
                self.assertIn('Persistent=true\n', text[paths[1]])
                for line in ('NoNewPrivileges=yes', 'ProtectSystem=strict', 'User=daemon', 'MemoryHigh=75%'):
                    self.assertIn(line + '\n', text[paths[0]])
                self.assertEqual(text[paths[0]].count('ReadWritePaths='), 1)
                printed = call([program, 'schedule', folder, '--print', 'systemd', '--at', '04:05', '--user', 'daemon', '--notify',
                                'echo "$BLOCKRAND_REASON" 50%', '--max-age', '30'])
                self.assertEqual(files_in(printed.out), {os.path.basename(p): t for p, t in text.items()})
                if not judge('systemd-analyze'):
                    continue
                verify = call(['systemd-analyze', 'verify', '--man=no', '--recursive-errors=no', *paths])
                ours = [line for line in verify.err.splitlines() if 'blockrand' in line or units in line]
                self.assertEqual((verify.code, ours), (0, []), verify)
                # A judge that sees nothing would pass everything: without the program it must fail.
                if '"' not in name:  # else sh is the program
                    os.rename(program, program + '.away')
                    self.assertNotEqual(call(['systemd-analyze', 'verify', '--man=no', '--recursive-errors=no', paths[0]]).code, 0)
                    os.rename(program + '.away', program)
                security = call(['systemd-analyze', 'security', '--offline=yes', '--no-pager', paths[0]])
                score = float(re.search(r'exposure level for \S+: ([\d.]+)', security.out).group(1))
                print(f'systemd-analyze security: {score}')
                self.assertLess(score, 3, security)

    def test_a_region_as_update_makes_it(self):
        """region.toml as the program writes it, and one that publishes outward: every kind of schedule is written."""
        folder = self.path('plain')
        self.update(folder, SAMPLE)
        settings = os.path.join(folder, 'region.toml')
        for kind in ('systemd', 'cron', 'slurm', 'kubernetes'):
            self.schedule(folder, kind)
        with open(settings, encoding='utf-8') as f:
            text = f.read()
        self.assertIn('[publish]', text)
        web = self.path('web')
        with open(settings, 'w', encoding='utf-8') as f:
            f.write(text.replace('[publish]', f'[publish]\nweb_root = "{web}"', 1))
        self.assertIn('Make the folder first', self.schedule(folder, 'systemd', code=1).err)  # a unit cannot open what is not there
        os.makedirs(web)
        with open(settings, 'w', encoding='utf-8') as f:
            f.write(text.replace('[publish]', f'[publish]\nweb_root = "{web}"', 1))
        if os.geteuid() == 0:  # what root writes there, the owner cannot remove
            os.chown(folder, 65534, -1)
            self.assertIn('chown -R', blockrand('update', folder, '--progress', 'none').err)
            os.chown(folder, 0, -1)
        self.assertIn(f'ReadWritePaths={web}', self.schedule(folder, 'systemd').out)

    def test_systemd_opens_what_region_toml_needs(self):
        folder = self.region('open', '[build]\nmemory_limit = 1000000000\n[region]\nhook = "curl example.org"\n')
        text = self.schedule(folder, 'systemd').out
        self.assertIn('AF_INET', text)
        self.assertNotIn('PrivateNetwork', text)
        self.assertIn('MemoryHigh=1250000000\n', text)
        self.assertNotIn('notify', text)
        self.assertIn('PrivateNetwork=yes', self.schedule(self.region('closed'), 'systemd').out)

    def test_cron_runs_a_night(self):
        """The line as cron hands it to sh: percent signs lose their backslash."""
        folder = self.region(self.ODD, f'[build]\ninput = "{SAMPLE}"\n')
        line = self.schedule(folder, 'cron', '--at', '03:07', '--max-age', '1e6').out.splitlines()[-1]
        minute, hour, *stars, command = line.split(' ', 5)
        self.assertEqual((minute, hour, stars), ('7', '3', ['*', '*', '*']))
        self.assertNotRegex(command, r'(?<!\\)%')
        run = call(['/bin/sh', '-c', command.replace('\\%', '%')], cwd='/', env={'HOME': '/nonexistent'})
        self.assertEqual((run.code, run.out), (0, ''), run)
        self.stands(folder, '000001')

    def test_kubernetes(self):
        settings = '[build]\nlod = 2\n[region]\nhook = "echo \'x: y\' # z"\n\n  # indented\n\tmax_age_hours = 5\n'
        modules = next((m for m in (Setup.node_modules, os.environ.get('BLOCKRAND_KUBERNETES_MODULES'))
                        if m and os.path.isdir(os.path.join(m, 'kubernetes-models'))), None)
        for name, shards in (('town', 1), (self.ODD, 3)):
            folder = self.region(name, settings)
            out = self.schedule(folder, 'kubernetes', '--shards', shards, '--at', '04:05').out
            self.assertNotIn('# FILE', out)
            if not modules or not shutil.which('node'):
                print('not checked: no schemas of Kubernetes (npm package kubernetes-models) are installed: not validated')
                self.assertIn(f'completions: {shards}\n', out)
                continue

            def check(text):
                run = call(['node', os.path.join(VALIDATORS, 'check_kubernetes.mjs'), modules, self.place('k.yaml', text)])
                return run, json.loads(run.out)
            run, told = check(out)
            self.assertEqual((run.code, [c['errors'] for c in told['checked']]), (0, [[], [], []]), run)
            config, claim, cron = told['documents']
            self.assertEqual(config['data']['region.toml'], settings)
            job = cron['spec']['jobTemplate']['spec']
            self.assertEqual((job['completionMode'], job['completions'], cron['spec']['schedule']), ('Indexed', shards, '5 4 * * *'))
            self.assertEqual(claim['spec']['accessModes'], ['ReadWriteMany' if shards > 1 else 'ReadWriteOnce'])
            # The judge sees what is wrong.
            for before, after in (('completions: ', 'completion: '), ('backoffLimit: 6', 'backoffLimit: six'), ('kind: CronJob', 'kind: Cron')):
                self.assertIn(before, out)
                self.assertEqual(check(out.replace(before, after))[0].code, 1, after)
            print(f'kubernetes-models {read_json(modules, "kubernetes-models", "package.json")["version"]}: {len(told["documents"])} documents valid')
            if shards > 1:
                pod = job['template']['spec']
                self.pods([pod['initContainers'][0]['args'][0], pod['containers'][0]['args'][0]], shards)

    def pods(self, scripts, shards):
        """The scripts of all pods at the same time, with a program that notes how it was called; one pod dies once."""
        place = self.path('volume')
        tools = self.path('tools')
        os.makedirs(tools)
        log = self.path('calls.txt')
        with open(os.path.join(tools, 'blockrand'), 'w', encoding='utf-8') as f:
            f.write(f'#!/bin/sh\necho "$@" >> {log}\nsleep 0.2\n'
                    f'case "$*" in *"--shard 2/"*) [ -e {self.path("died")} ] || {{ touch {self.path("died")}; exit 9; }};; esac\n')
        os.chmod(os.path.join(tools, 'blockrand'), 0o755)
        region = re.search(r'/regions/[\w-]+', scripts[0]).group()

        def pod(index):
            env = dict(os.environ, PATH=tools + ':' + os.environ['PATH'], JOB_NAME='night-1', JOB_COMPLETION_INDEX=str(index))
            text = '\n'.join(f'(\n{s.replace(region, place)})' + (' || exit $?' if s is scripts[0] else '') for s in scripts)
            return subprocess.Popen(['/bin/sh', '-c', text], env=env)
        # The last first: it waits until the first has planned.
        running = [pod(i) for i in reversed(range(shards))]
        codes = [p.wait(60) for p in running]
        self.assertEqual(sorted(codes), [0] * (shards - 1) + [9])
        self.assertEqual(pod(1).wait(60), 0, 'Kubernetes begins the pod again')
        with open(log, encoding='utf-8') as f:
            calls = [line.strip().replace(place, 'R') for line in f]
        self.assertEqual(calls.count(f'region plan R --shards {shards} --break-lock'), 1)
        self.assertEqual({c for c in calls if ' work ' in c}, {f'region work R --shard {i}/{shards}' for i in range(1, shards + 1)})
        self.assertEqual(calls.count('region finish R'), 1)
        self.assertEqual(calls[-1], 'region finish R', 'it comes when all have worked')

    def test_slurm_script(self):
        """With a sbatch that runs what it is given at once: what would be submitted, and how paths arrive."""
        folder = self.region(self.ODD)
        tools, log = self.path('slurm tools'), self.path('slurm.txt')
        os.makedirs(tools)
        with open(os.path.join(tools, 'sbatch'), 'w', encoding='utf-8') as f:
            f.write('#!/bin/sh\necho "sbatch $*" >> "$LOG"\ncat > "$LOG.job"\n'
                    'case "$*" in *--array*) export SLURM_ARRAY_TASK_ID=2;; esac\n'
                    'case "$*" in *notify*) ;; *) sh "$LOG.job" ;; esac 1>&2\necho "$(wc -l < "$LOG");cluster"\n')
        os.chmod(os.path.join(tools, 'sbatch'), 0o755)
        with open(os.path.join(tools, 'squeue'), 'w', encoding='utf-8') as f:
            f.write('#!/bin/sh\necho "$JOBS"\n')
        os.chmod(os.path.join(tools, 'squeue'), 0o755)
        program = self.fake_program(self.path('fake ' + self.ODD), log)
        script = call([program[0], 'schedule', folder, '--print', 'slurm', '--shards', '4', '--max-age', '30', '--notify', 'echo $BLOCKRAND_REASON'])
        self.assertEqual(script.code, 0, script)
        program[1]()
        run = call(['/bin/sh', self.place('night.sh', script.out)], env={'LOG': log, 'PATH': tools + ':' + os.environ['PATH']})
        self.assertEqual(run.code, 0, run)
        with open(log, encoding='utf-8') as f:
            lines = [line.strip() for line in f]
        calls = [line for line in lines if not line.startswith('sbatch')]
        self.assertEqual(calls, [f'region plan {folder} --shards 4 --break-lock', f'region work {folder} --shard 2/4', f'region finish {folder}',
                                 f'status {folder} --max-age 30'])
        # A plan that a broken night left is given up; while jobs are at work nothing is submitted.
        os.makedirs(os.path.join(folder, 'plan'))
        with open(os.path.join(folder, 'plan', 'plan.json'), 'w', encoding='utf-8') as f:
            f.write('{}')
        env = {'LOG': log, 'PATH': tools + ':' + os.environ['PATH']}
        self.assertEqual(call(['/bin/sh', self.place('night.sh', script.out)], env=env).code, 0)
        with open(log, encoding='utf-8') as f:
            self.assertIn(f'region drop {folder} --break-lock\n', f.read())
        busy = call(['/bin/sh', self.place('night.sh', script.out)], env={**env, 'JOBS': '7 night'})
        self.assertEqual(busy.code, 1, busy)
        self.assertIn('still at work', busy.err)
        shutil.rmtree(os.path.join(folder, 'plan'))
        jobs = [line for line in lines if line.startswith('sbatch')]
        self.assertIn('--array=1-4', jobs[1])
        self.assertIn('--dependency=afterok:2 ', jobs[1])
        self.assertIn('--dependency=afterok:4 ', jobs[2])
        self.assertIn('--dependency=afternotok:2?afternotok:4?afternotok:7 ', jobs[3])

    def fake_program(self, folder, log):
        """The program at an odd path, and what puts one there that only notes how it is called."""
        program = self.program_in(folder)

        def fake():
            with open(program + '.new', 'w', encoding='utf-8') as f:
                f.write(f'#!/bin/sh\necho "$@" >> "{log}"\n[ ! -e "{log}.fail" ]\n')
            os.chmod(program + '.new', 0o755)
            os.rename(program + '.new', program)
        return program, fake

    @unittest.skipUnless(os.geteuid() == 0, 'Slurm is started as root')
    def test_slurm_itself(self):
        if not all([judge('slurmctld'), judge('slurmd'), judge('munged')]):
            self.skipTest('not checked: Slurm is not installed')
        place = self.path('cluster')
        log = self.path('cluster.txt')
        with Slurm(place):
            folder = self.region("it's a town")
            program, fake = self.fake_program(self.path('fake slurm'), log)
            script = call([program, 'schedule', folder, '--print', 'slurm', '--shards', '3', '--notify', f'echo "$BLOCKRAND_REASON" >> {log}'])
            fake()
            for fails in (False, True):
                if fails:
                    open(log + '.fail', 'w', encoding='utf-8').close()
                run = call(['/bin/sh', self.place('night.sh', script.out)])
                self.assertEqual(run.code, 0, run)
                deadline = time.time() + 120
                while call(['squeue', '--noheader']).out.strip() and time.time() < deadline:
                    time.sleep(0.5)
                self.assertEqual(call(['squeue', '--noheader']).out, '', 'nothing waits for ever')
                with open(log, encoding='utf-8') as f:
                    calls = f.read().replace(folder, 'R').splitlines()
                os.remove(log)
                if fails:
                    self.assertEqual(calls[0], 'region plan R --shards 3 --break-lock')
                    self.assertEqual(len(calls), 2, calls)
                    self.assertIn('did not end well', calls[1])
                else:
                    self.assertEqual((calls[0], calls[-1]), ('region plan R --shards 3 --break-lock', 'region finish R'))
                    self.assertEqual(sorted(calls[1:-1]), [f'region work R --shard {i}/3' for i in (1, 2, 3)])
            print('Slurm', call(['sinfo', '--version']).out.strip() + ': a night, and one whose plan fails')


class Slurm:
    """A cluster of one node on this machine (after /work/shared/references/feasibility.md, section 6)."""

    def __init__(self, place):
        self.place, self.children = place, []

    def __enter__(self):
        place, host = self.place, socket.gethostname().split('.')[0]
        for folder in ('ctld', 'log', 'd-n1'):
            os.makedirs(os.path.join(place, folder))
        os.chmod(place, 0o755)
        os.chmod(os.path.dirname(place), 0o755)
        with open(os.path.join(place, 'munge.key'), 'wb') as f:
            f.write(os.urandom(128))
        os.chmod(os.path.join(place, 'munge.key'), 0o600)
        with socket.socket() as a, socket.socket() as b:
            a.bind(('127.0.0.1', 0)), b.bind(('127.0.0.1', 0))
            ports = a.getsockname()[1], b.getsockname()[1]
        conf = os.path.join(place, 'slurm.conf')
        with open(conf, 'w', encoding='utf-8') as f:
            f.write(f'''ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={place}/munge.sock,cred_expire=10
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
ReturnToService=2
SlurmdParameters=config_overrides
SlurmctldPort={ports[0]}
SlurmctldPidFile={place}/ctld.pid
SlurmdPidFile={place}/slurmd-%n.pid
StateSaveLocation={place}/ctld
SlurmdSpoolDir={place}/d-%n
SlurmctldLogFile={place}/log/ctld.log
SlurmdLogFile={place}/log/slurmd-%n.log
MinJobAge=10
NodeName=n1 NodeAddr=127.0.0.1 NodeHostname={host} Port={ports[1]} CPUs=2
PartitionName=main Nodes=n1 Default=YES State=UP
''')
        os.environ['SLURM_CONF'] = conf
        self.children.append(subprocess.Popen(['munged', '--foreground', '--force', f'--key-file={place}/munge.key', f'--socket={place}/munge.sock',
                                               f'--pid-file={place}/munged.pid', f'--log-file={place}/log/munged.log', f'--seed-file={place}/munged.seed'],
                                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        deadline = time.time() + 20
        while not os.path.exists(os.path.join(place, 'munge.sock')) and time.time() < deadline:
            time.sleep(0.1)
        for command in (['slurmctld', '-D', '-c'], ['slurmd', '-D', '-N', 'n1']):
            self.children.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        while call(['sinfo', '--noheader', '-o', '%T']).out.strip() != 'idle':
            if time.time() > deadline:
                self.__exit__()
                raise unittest.SkipTest('not checked: Slurm does not come up on this machine')
            time.sleep(0.3)
        return self

    def __exit__(self, *_):
        for child in reversed(self.children):
            child.terminate()
            try:
                child.wait(10)
            except subprocess.TimeoutExpired:
                child.kill()
        os.environ.pop('SLURM_CONF', None)


class Observed(RegionTest):
    def check_metrics(self, folder):
        if judge('promtool'):
            with open(os.path.join(folder, 'log', 'metrics.prom'), 'rb') as f:
                done = subprocess.run(['promtool', 'check', 'metrics'], stdin=f, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            self.assertEqual((done.returncode, done.stdout), (0, b''))
        return samples(folder)

    def test_nights_good_and_bad(self):
        told = self.path('told.txt')
        folder = self.region('town', f'[region]\nnotify = "echo $BLOCKRAND_STATE, $BLOCKRAND_REASON >> {told}"\n')
        self.update(folder, SAMPLE)
        m, build, run = self.check_metrics(folder), read_json(folder, 'current', 'build.json'), read_json(folder, 'current', 'run.json')
        self.assertEqual(m['blockrand_last_run_state', (('state', 'published'),)], 1)
        self.assertEqual(m['blockrand_models', (('lod', '2'),)], build['counts']['models_lod2'])
        self.assertEqual({k[1][1][1]: v for k, v in m.items() if k[0] == 'blockrand_reports'}, build['issues'])
        self.assertEqual(m['blockrand_last_run_tiles', (('work', 'built'),)], run['tiles']['built'])
        self.assertEqual(m['blockrand_last_run_peak_memory_bytes', ()] >= run['peak_rss_bytes'], True)
        slow = {k[1][0][1]: v for k, v in m.items() if k[0] == 'blockrand_last_run_slow_tile_seconds'}
        self.assertEqual(slow, {t['tile']: t['thread_seconds'] for t in run['slowest_tiles']})
        self.assertEqual(len(slow), min(10, run['tiles']['built']))
        self.assertAlmostEqual(m['blockrand_last_run_stage_duration_seconds', (('stage', 'tiles'),)], run['timings']['tiles'], delta=0.002)
        self.assertGreater(m['blockrand_disk_usage_bytes', (('folder', 'builds'),)], 0)
        first_success = m['blockrand_last_success_timestamp_seconds', ()]
        with open(os.path.join(folder, 'log', '000001.report.txt'), encoding='utf-8') as f:
            report = f.read()
        self.assertIn(run['slowest_tiles'][0]['tile'], report)
        for code, count in build['issues'].items():
            self.assertRegex(report, rf'(?m)^ +{count:,}  {code}$'.replace(',', '[, \u202f]?'))
        # Nothing to do: a good night all the same, without a word.
        self.update(folder, SAMPLE)
        self.assertEqual(self.check_metrics(folder)['blockrand_last_run_state', (('state', 'unchanged'),)], 1)
        self.assertFalse(os.path.exists(told))
        # Refused, then failed: what is published stays, and each is told in a line.
        self.update(folder, write_xml(self.path('empty.osm'), [Node(1, 11, 51)]), code=5)
        self.assertEqual(self.check_metrics(folder)['blockrand_last_run_state', (('state', 'refused'),)], 1)
        self.stands(folder, '000001')
        self.assertIn('max_lost', self.problem(folder)[1])
        time.sleep(1.1)
        self.assertEqual(blockrand('update', folder, self.path('absent.osc')).code, 2)
        m = self.check_metrics(folder)
        self.assertEqual(m['blockrand_last_run_state', (('state', 'failed'),)], 1)
        self.assertGreaterEqual(m['blockrand_last_success_timestamp_seconds', ()], first_success)
        self.assertLess(m['blockrand_last_success_timestamp_seconds', ()], m['blockrand_last_run_timestamp_seconds', ()])
        self.assertEqual(m['blockrand_published_build', ()], 1)
        self.assertEqual(m['blockrand_runs_total', (('state', 'failed'),)], 1)
        with open(told, encoding='utf-8') as f:
            lines = f.read().splitlines()
        self.assertEqual([line.split(',')[0] for line in lines], ['refused', 'failed'])
        self.assertIn('absent.osc', lines[1])
        self.assertEqual(self.problem(folder), ('failed', lines[1].split(', ', 1)[1]))
        self.assertIn('failed', blockrand('status', folder).out)
        # A good night takes the word back.
        self.update(folder, SAMPLE)
        self.assertIsNone(self.problem(folder))

    def problem(self, folder):
        """State and reason in log/last_problem.env, as sh reads them."""
        path = os.path.join(folder, 'log', 'last_problem.env')
        if not os.path.exists(path):
            return None
        run = call(['/bin/sh', '-c', '. "$0"; printf "%s\n%s" "$BLOCKRAND_STATE" "$BLOCKRAND_REASON"', path])
        return tuple(run.out.split('\n'))

    def test_a_damaged_region_toml_is_told_by_the_command_line(self):
        folder = self.region('broken', '[region\n')
        told = self.path('told2.txt')
        run = blockrand('update', folder, '--notify', f'echo "$BLOCKRAND_STATE $BLOCKRAND_REASON $BLOCKRAND_REGION" > {told}')
        self.assertEqual(run.code, 2, run)
        with open(told, encoding='utf-8') as f:
            text = f.read()
        self.assertTrue(text.startswith('failed ') and 'region.toml' in text and text.endswith(folder + '\n'), text)

    def test_old_data(self):
        told = self.path('old.txt')
        folder = self.region('old', f'[region]\nmax_age_hours = 24\nnotify = "echo $BLOCKRAND_STATE, $BLOCKRAND_REASON > {told}"\n')
        run = self.update(folder, SAMPLE, code=3)
        self.assertIn('hours old', run.err)
        self.stands(folder, '000001')
        with open(told, encoding='utf-8') as f:
            self.assertRegex(f.read(), r'^stale, the data of build 1 are [\d.]+ hours old \(.*\); max_age_hours is 24\n$')
        self.assertEqual(self.problem(folder)[0], 'stale')
        m = self.check_metrics(folder)
        self.assertEqual(m['blockrand_data_max_age_seconds', ()], 24 * 3600)
        self.assertGreater(time.time() - m['blockrand_data_timestamp_seconds', ()], 24 * 3600)
        run = blockrand('status', folder)
        self.assertEqual(run.code, 3, run)
        self.assertEqual(len([line for line in run.out.splitlines() if 'hours old' in line]), 1)
        self.assertEqual(blockrand('status', folder, '--json').code, 3)
        self.assertEqual(blockrand('status', folder, '--max-age', '1000000').code, 0)
        self.assertEqual(blockrand('status', folder, '--max-age', '0').code, 0)

    def test_change_files_that_brought_nothing_make_data_newer(self):
        folder = self.region('still', '[region]\nreplication = "changes"\nfirst_sequence = 1\n')
        changes = os.path.join(folder, 'changes')
        os.makedirs(os.path.join(changes, '000', '000'))
        now = time.strftime('%Y-%m-%dT%H\\:%M\\:%SZ', time.gmtime(time.time() - 3600))
        for path in ('state.txt', '000/000/001.state.txt'):
            self.place(os.path.join(changes, path), f'sequenceNumber=1\ntimestamp={now}\n')
        self.place(os.path.join(changes, '000/000/001.osc'), '<osmChange version="0.6"></osmChange>')
        import gzip
        with gzip.open(os.path.join(changes, '000/000/001.osc.gz'), 'wb') as f:
            f.write(b'<osmChange version="0.6"></osmChange>')
        self.update(folder, SAMPLE)
        self.assertEqual(blockrand('status', folder, '--max-age', '24').code, 3)
        self.assertIn('up to date', self.update(folder).out)
        run = blockrand('status', folder, '--max-age', '24')
        self.assertEqual(run.code, 0, run)

    def test_a_build_without_a_region(self):
        file = self.path('build.prom')
        folder = self.build(SAMPLE, 'once', '--metrics', file)
        with open(file, encoding='utf-8') as f:
            text = f.read()
        self.assertIn(f'lod="2"}} {read_json(folder, "build.json")["counts"]["models_lod2"]}\n', text)
        if judge('promtool'):
            done = subprocess.run(['promtool', 'check', 'metrics'], input=text.encode(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            self.assertEqual((done.returncode, done.stdout), (0, b''))

    def test_dashboard_and_alerts_ask_for_what_is_written(self):
        folder = self.region('asked', '[region]\nmax_age_hours = 1e6\n')
        self.update(folder, SAMPLE)
        written = {name for name, _ in samples(folder)}
        for path in ('packaging/grafana-dashboard.json', 'packaging/alerts.yml', 'docs/operations.md'):
            with open(os.path.join(SOURCE, path), encoding='utf-8') as f:
                asked = set(re.findall(r'\bblockrand_[a-z_]+[a-z]\b', f.read()))
            self.assertTrue(asked, path)
            self.assertEqual(asked - written, set(), path)
        dashboard = read_json(SOURCE, 'packaging', 'grafana-dashboard.json')
        self.assertEqual(len({p['id'] for p in dashboard['panels']}), len(dashboard['panels']))
        for panel in dashboard['panels']:
            self.assertTrue(panel['targets'] and panel['title'], panel)
            for target in panel['targets']:
                if shutil.which('promtool'):
                    # promtool reads an expression as that of a rule.
                    rule = self.place('rule.yml', json.dumps({'groups': [{'name': 'g', 'rules': [{'record': 'x', 'expr': target['expr'].replace('$region', '.+')}]}]}))
                    done = call(['promtool', 'check', 'rules', rule])
                    self.assertEqual(done.code, 0, done)
        if judge('promtool'):
            self.alerts_fire()

    def alerts_fire(self):
        def series(name, labels, value):
            return {'series': f'{name}{{region="town"{labels}}}', 'values': f'{value}+0x120'}
        good = [series('blockrand_last_run_state', ',state="published"', 1), series('blockrand_last_run_state', ',state="failed"', 0),
                series('blockrand_last_run_timestamp_seconds', '', 0), series('blockrand_last_success_timestamp_seconds', '', 0),
                series('blockrand_data_timestamp_seconds', '', 0), series('blockrand_data_max_age_seconds', '', 86400),
                series('blockrand_disk_free_bytes', '', 1e9), series('blockrand_disk_usage_bytes', ',folder="builds"', 1e9)]
        bad = [series('blockrand_last_run_state', ',state="failed"', 1), series('blockrand_last_run_timestamp_seconds', '', -1e5),
               series('blockrand_last_success_timestamp_seconds', '', -1e6), series('blockrand_data_timestamp_seconds', '', -1e5),
               series('blockrand_data_max_age_seconds', '', 86400), series('blockrand_disk_free_bytes', '', 1e8),
               series('blockrand_disk_usage_bytes', ',folder="builds"', 1e9)]
        rules = os.path.join(SOURCE, 'packaging', 'alerts.yml')
        with open(rules, encoding='utf-8') as f:
            names = re.findall(r'- alert: (\w+)', f.read())

        def fired(name, input_):
            test = {'rule_files': [rules], 'evaluation_interval': '1m',
                    'tests': [{'interval': '1m', 'input_series': input_, 'alert_rule_test': [{'eval_time': '100m', 'alertname': name, 'exp_alerts': []}]}]}
            return call(['promtool', 'test', 'rules', self.place('alerts_test.yml', json.dumps(test))]).code != 0
        self.assertEqual([n for n in names if fired(n, good)], [])
        self.assertEqual([n for n in names if fired(n, bad)], names)


if __name__ == '__main__':
    main()
