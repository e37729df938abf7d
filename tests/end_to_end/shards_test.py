"""A night whose areas several processes build: plan, work, finish. What stands in the morning is what `update` would have built."""
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import time

from areas_test import areas, wait_for_a_worker, without_runs
from blockrand_run import Setup, blockrand, hashes, main, read_json
from osm_files import town
from region_run import LIMITS_OFF, Map, RegionTest

LEVEL = '14'
SHARDS = 3
SETTINGS = LIMITS_OFF + f'[build]\nlod = 2\nareas = {LEVEL}\njobs = 1\n'


class ShardTest(RegionTest):
    def same_build(self, a, b):
        first, second = (without_runs(hashes(f)) for f in (a, b))
        self.assertTrue(first)
        self.assertEqual(sorted(p for p in first.keys() | second.keys() if first.get(p) != second.get(p)), [])

    def published(self, folder, build):
        self.assertEqual(os.path.basename(self.current(folder)), build)
        sound = blockrand('validate', self.current(folder))
        self.assertEqual(sound.code, 0, sound)

    def region_command(self, action, folder, *arguments, code=0):
        run = blockrand('region', action, folder, *arguments, '--progress', 'none')
        self.assertEqual(run.code, code, run)
        return run

    def plan(self, folder, *data, shards=SHARDS):
        return self.region_command('plan', folder, *data, '--shards', str(shards))

    def last_run(self, folder):
        with open(os.path.join(folder, 'log', 'runs.jsonl'), encoding='utf-8') as f:
            return json.loads(f.readlines()[-1])


class Shards(ShardTest):
    def start(self, folder, shard, shards=SHARDS):
        return subprocess.Popen([Setup.program, 'region', 'work', folder, '--shard', f'{shard}/{shards}', '--progress', 'none'],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def test_nights(self):
        """Each night is shared otherwise: side by side, one after the other, with workers that are killed and run again."""
        map_, rng = Map(town(1200)), random.Random(5)
        folder = self.region('province', SETTINGS)
        extract = map_.write(self.path('province.osm'))
        killed = 0
        for night in range(5):
            if night > 0:
                map_.random_edits(rng, rng.choice([1, 3, 8]))
                extract = map_.write_changes(self.path('night.osc'))
            planned = self.plan(folder, extract)
            if self.last_run(folder)['state'] == 'unchanged':
                continue
            self.assertIn('areas are to be built', planned.out)
            workers = [self.start(folder, shard) for shard in range(1, SHARDS + 1)]
            if night % 2 == 0:
                victim = workers[rng.randrange(SHARDS)]
                wait_for_a_worker(victim)
                time.sleep(rng.uniform(0, 0.4))
                victim.send_signal(signal.SIGKILL)
            codes = [(w.communicate()[0], w.returncode) for w in workers]
            for shard, (words, code) in enumerate(codes, 1):
                self.assertIn(code, (0, -signal.SIGKILL), words)
                if code != 0:
                    killed += 1
                    again = self.region_command('work', folder, '--shard', f'{shard}/{SHARDS}')
                    self.assertIn('areas were built', again.out)
            self.region_command('finish', folder)
            self.assertFalse(os.path.exists(os.path.join(folder, 'plan')))
            self.assertEqual(self.last_run(folder)['state'], 'published')
            self.same_build(self.current(folder), self.clean(map_, folder, '--lod', '2', '--areas', LEVEL))
        self.assertGreater(killed, 0)
        map_.random_edits(rng, 2)  # and an ordinary night again
        self.update(folder, map_.write_changes(self.path('night.osc')))
        self.same_build(self.current(folder), self.clean(map_, folder, '--lod', '2', '--areas', LEVEL))
        self.published(folder, os.path.basename(self.current(folder)))

    def test_work_is_balanced_by_what_it_took(self):
        folder = self.region('balance', SETTINGS)
        self.update(folder, Map(town(1200)).write(self.path('balance.osm')))
        took = {a: read_json(self.current(folder), f'areas/{a}/run.json')['cpu_seconds_of_whole'] for a in areas(self.current(folder))}
        with open(os.path.join(folder, 'region.toml'), 'a', encoding='utf-8') as f:
            f.write('seed = 5\n')  # everything is built anew
        self.plan(folder, shards=2)
        planned = read_json(folder, 'plan/plan.json')['areas']
        self.assertEqual({a: p['cpu_seconds'] for a, p in planned.items()}, took)
        sums = [sum(p['cpu_seconds'] for p in planned.values() if p['shard'] == shard) for shard in (1, 2)]
        best = min(max(sum(t for n, t in enumerate(took.values()) if choice >> n & 1), sum(t for n, t in enumerate(took.values()) if not choice >> n & 1))
                   for choice in range(2 ** len(took)))
        self.assertLessEqual(max(sums), 7 / 6 * best + 1e-6)  # Graham's bound of the longest first, two shards

    def test_words(self):
        map_ = Map(town(300))
        extract = map_.write(self.path('words.osm'))
        folder = self.region('words', SETTINGS)
        self.refused(blockrand('region', 'work', self.path('none'), '--shard', '1/2'), 1)
        self.plan(folder, extract, shards=2)
        self.refused(blockrand('update', folder, extract), 1, 'plan', 'region finish', 'region drop')
        self.refused(blockrand('region', 'plan', folder, extract), 1, 'region drop')
        self.refused(blockrand('region', 'finish', folder), 1, 'missing', '1/2')
        self.refused(blockrand('region', 'work', folder), 1, '--shard')
        for shard in ('0/2', '3/2', '2', 'a/b', '1/2/3', '1/'):
            self.refused(blockrand('region', 'work', folder, '--shard', shard), 1, shard)
        self.refused(blockrand('region', 'work', folder, '--shard', '1/4'), 1, '2 shards')
        self.refused(blockrand('region', 'work', folder, extract, '--shard', '1/2'), 1, 'no data')
        self.refused(blockrand('region', 'finish', folder, '--shards', '2'), 1, '--shards')
        self.assertIn('under way in 2 shards', blockrand('status', folder).out)
        with open(os.path.join(folder, 'region.toml'), 'a', encoding='utf-8') as f:
            f.write('seed = 5\n')
        self.refused(blockrand('region', 'work', folder, '--shard', '1/2'), 1, 'region.toml')
        self.region_command('drop', folder)
        self.assertEqual(os.listdir(os.path.join(folder, 'store')), [])
        self.refused(blockrand('region', 'drop', folder), 1, 'no plan')
        for lost in (('finish', folder), ('work', folder, '--shard', '1/2')):
            self.refused(blockrand('region', *lost), 1, 'no plan')
        self.plan(folder, extract, shards=2)
        for shard in ('1/2', '2/2'):
            self.region_command('work', folder, '--shard', shard)
        # An area that was damaged meanwhile is told, and built again.
        some = areas(os.path.join(folder, 'plan'))[0]
        os.truncate(os.path.join(folder, 'plan', 'areas', some, 'build.json'), 10)
        self.refused(blockrand('region', 'finish', folder), 2, some, 'shard')
        for shard in ('1/2', '2/2'):
            self.region_command('work', folder, '--shard', shard)
        self.region_command('finish', folder)
        self.published(folder, '000001')
        # A plan that finds nothing to build: the other jobs of that night have nothing to do, and that is no failure.
        self.assertIn('nothing to build', blockrand('region', 'plan', folder, '--shards', '2').out)
        for nothing in (('work', folder, '--shard', '1/2'), ('finish', folder)):
            run = blockrand('region', *nothing)
            self.assertEqual(run.code, 0, run)
            self.assertIn('nothing to do', run.out)
        self.refused(blockrand('region', 'work', folder, '--shard', 'rubbish'), 1, 'rubbish')
        whole = self.region('whole', LIMITS_OFF)
        self.refused(blockrand('region', 'plan', whole, extract), 1, 'areas = ')
        self.assertFalse(os.path.exists(os.path.join(whole, 'plan')))

    def test_what_stands_around_the_houses(self):
        """At LoD3, where it is made without being asked for."""
        map_ = Map(town(150))
        folder = self.region('around', SETTINGS.replace('lod = 2', 'lod = 3'))
        self.plan(folder, map_.write(self.path('around.osm')), shards=2)
        for shard in ('1/2', '2/2'):
            self.region_command('work', folder, '--shard', shard)
        self.region_command('finish', folder)
        self.assertIn('surroundings', json.dumps(read_json(self.current(folder), 'build.json')['configuration']))
        self.same_build(self.current(folder), self.clean(map_, folder, '--lod', '3', '--areas', LEVEL))

    def test_the_same_shard_twice_at_once(self):
        map_ = Map(town(300))
        folder = self.region('twice', SETTINGS)
        self.plan(folder, map_.write(self.path('twice.osm')), shards=1)
        workers = [self.start(folder, 1, 1) for _ in range(3)]
        for w in workers:
            words = w.communicate()[0]
            self.assertEqual(w.returncode, 0, words)
        self.region_command('finish', folder)
        self.same_build(self.current(folder), self.clean(map_, folder, '--lod', '2', '--areas', LEVEL))

    def test_areas_of_another_plan_do_not_count(self):
        """A process that outlived its plan hands in what it built of other settings."""
        folder = self.region('stale', SETTINGS)
        extract = Map(town(300)).write(self.path('stale.osm'))
        self.plan(folder, extract, shards=1)
        self.region_command('work', folder, '--shard', '1/1')
        old = self.path('old_plan')
        shutil.copytree(os.path.join(folder, 'plan'), old)
        self.region_command('drop', folder)
        with open(os.path.join(folder, 'region.toml'), 'a', encoding='utf-8') as f:
            f.write('seed = 5\n')
        self.plan(folder, extract, shards=1)
        for name in ('areas', 'done'):
            shutil.copytree(os.path.join(old, name), os.path.join(folder, 'plan', name))
        self.refused(blockrand('region', 'finish', folder), 1, 'missing', '1/1')
        self.assertIn(', 0 were done already', self.region_command('work', folder, '--shard', '1/1').out)
        self.region_command('finish', folder)
        self.published(folder, '000001')

    def test_a_finish_that_was_broken_off_is_run_again(self):
        map_ = Map(town(300))
        folder = self.region('late', SETTINGS)
        self.plan(folder, map_.write(self.path('late.osm')), shards=1)
        self.region_command('work', folder, '--shard', '1/1')
        plan = self.path('late_plan')
        shutil.copytree(os.path.join(folder, 'plan'), plan)
        # Built, but not published.
        left = os.path.join(folder, 'builds', '000001')
        os.makedirs(left)
        shutil.copy(os.path.join(plan, 'areas', areas(plan)[0], 'build.json'), left)
        self.region_command('finish', folder)
        self.same_build(self.current(folder), self.clean(map_, folder, '--lod', '2', '--areas', LEVEL))
        # Published, but the plan not yet removed.
        shutil.copytree(plan, os.path.join(folder, 'plan'))
        self.assertIn('published already', self.region_command('finish', folder).err)
        self.assertFalse(os.path.exists(os.path.join(folder, 'plan')))
        self.published(folder, '000001')
        # A plan without its last file is none.
        shutil.copytree(plan, os.path.join(folder, 'plan'))
        os.remove(os.path.join(folder, 'plan', 'plan.json'))
        self.assertIn('broken off', self.update(folder).err)
        self.assertFalse(os.path.exists(os.path.join(folder, 'plan')))

    def test_a_gate_refuses(self):
        """A vandalised extract does not come in by way of shards, either."""
        map_ = Map(town(300))
        folder = self.region('gate', f'[build]\nlod = 2\nareas = {LEVEL}\n')
        self.update(folder, map_.write(self.path('gate.osm')))
        for b in map_.ways('building')[:60]:
            map_.delete(b)
        self.plan(folder, map_.write_changes(self.path('gate.osc')), shards=1)
        self.region_command('work', folder, '--shard', '1/1')
        self.assertIn('max_lost', self.region_command('finish', folder, code=5).out)
        self.published(folder, '000001')
        self.assertFalse(os.path.exists(os.path.join(folder, 'plan')))


CONFIGURATION = '''ClusterName=ci
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock,cred_expire=10
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
MpiDefault=none
ReturnToService=2
JobRequeue=1
SlurmdParameters=config_overrides
SlurmdTimeout=10
KillWait=5
SlurmctldPort={ports[0]}
SlurmctldPidFile={folder}/ctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
StateSaveLocation={folder}/ctld
SlurmdSpoolDir={folder}/d-%n
SlurmctldLogFile={folder}/ctld.log
SlurmdLogFile={folder}/slurmd-%n.log
NodeName=n1 NodeAddr=127.0.0.1 NodeHostname={host} Port={ports[1]} CPUs=1 RealMemory=2000
NodeName=n2 NodeAddr=127.0.0.1 NodeHostname={host} Port={ports[2]} CPUs=1 RealMemory=2000
PartitionName=main Nodes=n1,n2 Default=YES State=UP
'''


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(('127.0.0.1', 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Slurm(ShardTest):
    """A job array on two nodes of one machine, of which one is lost in the middle."""

    def setUp(self):
        missing = [p for p in ('slurmctld', 'slurmd', 'munged', 'sbatch', 'squeue') if not shutil.which(p)]
        if missing or os.geteuid() != 0:
            self.skipTest('not checked: Slurm ' + (f'is not installed ({", ".join(missing)}; slurm-wlm, munge)' if missing else 'needs root here'))
        self.place_ = self.path('slurm')
        os.makedirs(os.path.join(self.place_, 'ctld'))
        self.addCleanup(self.stop)
        key = os.path.join(self.place_, 'munge.key')
        with open(key, 'wb') as f:
            f.write(os.urandom(128))
        os.chmod(key, 0o600)
        os.chmod(self.place_, 0o755)
        subprocess.run(['munged', '--force', f'--key-file={key}', f'--socket={self.place_}/munge.sock', f'--pid-file={self.place_}/munged.pid',
                        f'--log-file={self.place_}/munged.log', f'--seed-file={self.place_}/munged.seed'], check=True)
        configuration = os.path.join(self.place_, 'slurm.conf')
        with open(configuration, 'w', encoding='utf-8') as f:
            f.write(CONFIGURATION.format(host=socket.gethostname().split('.')[0], folder=self.place_, ports=free_ports(3)))
        self.environment = dict(os.environ, SLURM_CONF=configuration)
        for command in (['slurmctld', '-c'], ['slurmd', '-N', 'n1'], ['slurmd', '-N', 'n2']):
            subprocess.run(command, env=self.environment, check=True)

    def pid(self, name):
        with open(os.path.join(self.place_, name), encoding='utf-8') as f:
            return int(f.read())

    def stop(self):
        for name in ('slurmd-n1.pid', 'slurmd-n2.pid', 'ctld.pid', 'munged.pid'):
            try:
                os.kill(self.pid(name), signal.SIGTERM)
            except (OSError, ValueError):
                pass

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, check=True, capture_output=True, text=True).stdout

    def wait(self, until, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if until():
                return
            time.sleep(0.3)
        self.fail(self.ask('squeue', '-a') + self.ask('sinfo'))

    def lose(self, node):
        """The node's daemon and all that it runs are gone at once."""
        daemon = self.pid(f'slurmd-{node}.pid')
        os.kill(daemon, signal.SIGKILL)
        with subprocess.Popen(['ps', '-eo', 'pid,args'], stdout=subprocess.PIPE, text=True) as ps:
            lines = [line.split(None, 1) for line in ps.stdout]
        steps = {int(pid) for pid, *args in lines if args and 'slurmstepd' in args[0]}
        for pid in steps:
            # Steps of the other node live on.
            try:
                with open(f'/proc/{pid}/environ', 'rb') as f:
                    of_node = f'SLURMD_NODENAME={node}'.encode() in f.read() or node.encode() in open(f'/proc/{pid}/cmdline', 'rb').read()
            except OSError:
                continue
            for child in self.tree(pid):
                with open(f'/proc/{child}/environ', 'rb') as f:
                    if f'SLURMD_NODENAME={node}'.encode() in f.read():
                        of_node = True
            if of_node:
                for one in [pid, *self.tree(pid)]:
                    try:
                        os.kill(one, signal.SIGKILL)
                    except OSError:
                        pass

    def tree(self, root):
        with subprocess.Popen(['ps', '-eo', 'pid,ppid'], stdout=subprocess.PIPE, text=True) as ps:
            pairs = [tuple(map(int, line.split())) for line in list(ps.stdout)[1:]]
        found, grown = [], {root}
        while grown:
            grown = {pid for pid, parent in pairs if parent in grown}
            found.extend(grown)
        return found

    def test_a_lost_node(self):
        map_ = Map(town(1200))
        folder = self.region('cluster', SETTINGS.replace('lod = 2', 'lod = 3'))
        self.plan(folder, map_.write(self.path('cluster.osm')), shards=4)
        script = self.path('work.sh')
        with open(script, 'w', encoding='utf-8') as f:
            f.write(f'#!/bin/sh\nexec {Setup.program} region work {folder} --shard $SLURM_ARRAY_TASK_ID/4 --progress none\n')
        os.chmod(script, 0o755)
        submit = ['sbatch', '--parsable', f'--chdir={self.place_}', '--mem=500', '--cpus-per-task=1']
        array = self.ask(*submit, '--array=1-4', '--requeue', f'--output={self.place_}/work-%a.log', script).strip()
        last = self.ask(*submit, f'--dependency=afterok:{array}', f'--output={self.place_}/finish.log', '--wrap',
                        f'{Setup.program} region finish {folder} --progress none').strip()
        on_n2 = lambda: self.ask('squeue', '-h', '-w', 'n2', '-t', 'R', '-o', '%i').split()
        self.wait(on_n2, 30)
        self.wait(lambda: os.path.isdir(os.path.join(folder, 'plan', 'parts')), 30)
        lost = on_n2()
        self.lose('n2')
        self.wait(lambda: not self.ask('squeue', '-h', '-a', '-j', f'{array},{last}').strip(), 240)
        with open(os.path.join(self.place_, 'finish.log'), encoding='utf-8') as f:
            words = f.read()
        self.assertIn('build 1 is published', words)
        self.assertTrue(lost)
        print(f'a node was lost with {", ".join(lost)}; ' + words.splitlines()[0])
        self.same_build(self.current(folder), self.clean(map_, folder, '--lod', '3', '--areas', LEVEL))


if __name__ == '__main__':
    main()
