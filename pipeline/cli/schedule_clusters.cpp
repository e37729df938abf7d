// Slurm and Kubernetes: plan, work in shards at the same time, finish.
#include <fmt/format.h>

#include "pipeline/base/error.h"
#include "pipeline/base/text.h"
#include "pipeline/cli/schedule_files.h"
#include "pipeline/cli/schedule_quoting.h"

namespace blockrand::cli {
namespace {

/// A here-document of sh: nothing in it is replaced.
constexpr const char* kEnd = "END_OF_JOB";

std::string job(std::string_view variable, std::string_view name, const std::string& options, const std::string& body) {
  return fmt::format(
      "{0}=$(sbatch --parsable --job-name={1} {2} <<'{3}'\n#!/bin/sh\nset -eu\n{4}{3}\n)\n{0}=${{{0}%%;*}}\n", variable,
      quoted_for_sh(name), options, kEnd, body);
}

std::string too_old_check(const std::string& program, const std::string& region, double hours) {
  if (hours <= 0) return "";
  return fmt::format("{} status {} --max-age {}\n", program, region, base::shortest(hours));
}

// ---- Kubernetes

/// Text of a block of YAML, each line behind `indent` spaces.
std::string indented(std::string_view text, std::size_t indent) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (end > at) out += std::string(indent, ' ') + std::string(text.substr(at, end - at));
    out += '\n';
    at = end + 1;
  }
  return out;
}

/// \throws base::UsageError  it holds what a block of YAML cannot
std::string block(std::string_view what, const std::string& text, std::size_t indent) {
  std::string lines = text;
  std::erase(lines, '\r');
  std::string without = lines;
  std::erase_if(without, [](char c) { return c == '\n' || c == '\t'; });
  check_text(what, without);
  return "|2\n" + indented(lines, indent);
}

std::string config_map(const Schedule& s, const std::string& name) {
  return fmt::format("apiVersion: v1\nkind: ConfigMap\nmetadata:\n  name: {}\ndata:\n  region.toml: {}", name,
                     // "|2": two more columns than the key, whatever the first line begins with
                     block("region.toml", s.settings, 4));
}

std::string volume_claim(const Schedule& s, const std::string& name) {
  return fmt::format(
      "apiVersion: v1\nkind: PersistentVolumeClaim\nmetadata:\n  name: {}\nspec:\n  accessModes: [{}]\n"
      "  resources:\n    requests:\n      # docs/operations.md says how much\n      storage: 50Gi\n",
      name, s.shards > 1 ? "ReadWriteMany" : "ReadWriteOnce");
}

/// The containers of a pod: in each, the region lies at `place`.
struct Container {
  std::string name, script;
};

std::string container(const Container& c, const Schedule& s, const std::string& place) {
  const std::uint64_t memory = s.memory_limit > 0 ? s.memory_limit + s.memory_limit / 4 : 4'000'000'000;
  return fmt::format(R"(            - name: {0}
              image: {1}
              command: ["/bin/sh", "-c"]
              args:
                - |2
{2}              env:
                - name: JOB_NAME
                  valueFrom:
                    fieldRef:
                      fieldPath: metadata.labels['job-name']
              resources:
                requests:
                  cpu: "1"
                  memory: "{3}"
                limits:
                  memory: "{4}"
              securityContext:
                allowPrivilegeEscalation: false
                readOnlyRootFilesystem: true
                capabilities:
                  drop: [ALL]
              volumeMounts:
                - name: region
                  mountPath: {5}
                - name: settings
                  mountPath: {5}/region.toml
                  subPath: region.toml
                - name: tmp
                  mountPath: /tmp
)",
                     c.name, quoted_for_yaml(s.image), indented(c.script, 18), memory, memory + memory / 2, place);
}

Container update_container(const Schedule& s, const std::string& place) {
  std::string script = "# No other run is at work (concurrencyPolicy): a lock is that of a pod that is gone.\n";
  script += fmt::format("exec blockrand update {} --break-lock --progress plain --log-format json", place);
  if (s.max_age_hours > 0) script += " --max-age " + base::shortest(s.max_age_hours);
  if (s.notify_given && !s.notify.empty()) script += " --notify " + quoted_for_sh(s.notify);
  return {"update", script + "\n"};
}

std::string plan_script(const Schedule& s, const std::string& place) {
  return fmt::format(R"SH(set -eu
night={0}/log/nights/$JOB_NAME
mkdir -p "$night"
# The first pod plans the night, the others wait for it.
if [ "$JOB_COMPLETION_INDEX" = 0 ] && [ ! -e "$night/planned" ]; then
  # A plan older than a job may take is that of a night that ended in the middle. Locks of pods that are gone are no obstacle.
  [ -z "$(find {0}/plan/plan.json -mmin +1385 2>/dev/null)" ] || blockrand region drop {0} --break-lock
  blockrand region plan {0} --shards {1} --break-lock
  touch "$night/planned"
fi
until [ -e "$night/planned" ]; do sleep 5; done
)SH",
                     place, s.shards);
}

std::string work_script(const Schedule& s, const std::string& place) {
  return fmt::format(R"SH(set -eu
night={0}/log/nights/$JOB_NAME
blockrand region work {0} --shard "$((JOB_COMPLETION_INDEX + 1))/{1}"
touch "$night/worked-$JOB_COMPLETION_INDEX"
[ "$(find "$night" -name 'worked-*' | wc -l)" -eq {1} ] || exit 0
# Who is the first to see that all is done finishes the night; after a failure the same one again.
ln -s "$JOB_COMPLETION_INDEX" "$night/finished_by" 2>/dev/null || true
[ "$(readlink "$night/finished_by")" = "$JOB_COMPLETION_INDEX" ] || exit 0
blockrand region finish {0}
find {0}/log/nights -mindepth 1 -maxdepth 1 ! -name "$JOB_NAME" -exec rm -r {{}} +
{2})SH",
                     place, s.shards, too_old_check("blockrand", place, s.max_age_hours));
}

std::string cron_job(const Schedule& s, const std::string& name) {
  const std::string place = "/regions/" + name;
  std::string containers, inits;
  if (s.shards > 1) {
    inits = "          initContainers:\n" + container({"plan", plan_script(s, place)}, s, place);
    containers = container({"work", work_script(s, place)}, s, place);
  } else {
    containers = container(update_container(s, place), s, place);
  }
  return fmt::format(R"(apiVersion: batch/v1
kind: CronJob
metadata:
  name: {0}
spec:
  # In the time zone of the cluster, unless spec.timeZone says another one.
  schedule: "{1} {2} * * *"
  concurrencyPolicy: Forbid
  startingDeadlineSeconds: 36000
  successfulJobsHistoryLimit: 3
  failedJobsHistoryLimit: 3
  jobTemplate:
    spec:
      completionMode: Indexed
      completions: {3}
      parallelism: {3}
      backoffLimit: 6
      activeDeadlineSeconds: 82800
      # Data that cannot be read and gates say the same the next time: 2, 3, 5.
      podFailurePolicy:
        rules:
          - action: FailJob
            onExitCodes:
              containerName: {4}
              operator: In
              values: [2, 3, 5]
          # A pod that its node lost does not count.
          - action: Ignore
            onPodConditions:
              - type: DisruptionTarget
                status: "True"
      template:
        spec:
          restartPolicy: Never
          automountServiceAccountToken: false
          securityContext:
            runAsNonRoot: true
            runAsUser: 1000
            runAsGroup: 1000
            fsGroup: 1000
            seccompProfile:
              type: RuntimeDefault
{5}          containers:
{6}          volumes:
            - name: region
              persistentVolumeClaim:
                claimName: {0}
            - name: settings
              configMap:
                name: {0}
            - name: tmp
              emptyDir: {{}}
)",
                     name, s.minute, s.hour, s.shards, s.shards > 1 ? "work" : "update", inits, containers);
}

}  // namespace

std::vector<ScheduleFile> slurm_files(const Schedule& s) {
  const std::string program = quoted_for_sh(s.program), region = quoted_for_sh(s.region), name = "blockrand-" + s.name,
                    log = s.region + "/log", enter = "cd " + quoted_for_sh(s.folder) + "\n";
  const auto common = [&](std::string_view step, std::string_view numbers) {
    return fmt::format("--chdir={} --output=slurm-{}-{}.txt --open-mode=append", quoted_for_sh(log), step, numbers);
  };
  // Where one ends badly, those that wait for it go as well.
  const std::string after = " --kill-on-invalid-dep=yes --dependency=";
  std::string out = fmt::format(
      "#!/bin/sh\n# Submits a night of the region {0}: plan, work in {1} jobs at the same time, finish.\n"
      "# Every night, where the cluster has scrontab (scrontab -e), or in the crontab of a login node:\n"
      "#   {2} {3} * * * sh /path/of/this/file\n"
      "# What all nodes must see: the program, the region, and the folder that this was written in. Memory and cores "
      "of a "
      "job are\n# those of the partition, unless SBATCH_… in the environment or options beside --job-name say others.\n"
      "set -eu\nmkdir -p {4}\nfind {4} -name 'slurm-*.txt' -mtime +30 -delete\n"
      "jobs=$(squeue --noheader --me --name={5}-plan,{5}-work,{5}-finish)\n"
      "if [ -n \"$jobs\" ]; then\n"
      "  echo 'the night before is still at work: nothing is submitted' >&2\n  exit 1\nfi\ntouch {4}/slurm-night\n\n",
      s.name, s.shards, s.minute, s.hour, quoted_for_sh(log), quoted_for_sh(name));
  out += job("plan", name + "-plan", "--requeue " + common("plan", "%j"),
             fmt::format("{0}# A plan that is left is that of a night of which a job was lost.\n"
                         "# Locks of hosts that are gone are no obstacle: no other job of it is at work.\n"
                         "[ ! -e {2}/plan/plan.json ] || {1} region drop {2} --break-lock\nexec {1} region plan {2} "
                         "--shards {3} --break-lock\n",
                         enter, program, region, s.shards));
  out += job(
      "work", name + "-work",
      fmt::format("--requeue --array=1-{}{}\"afterok:$plan\" {}", s.shards, after, common("work", "%A_%a")),
      fmt::format("{}exec {} region work {} --shard \"$SLURM_ARRAY_TASK_ID/{}\"\n", enter, program, region, s.shards));
  out += job("finish", name + "-finish", "--requeue" + after + "\"afterok:$work\" " + common("finish", "%j"),
             fmt::format("{}{} region finish {}\n{}", enter, program, region,
                         too_old_check(program, region, s.max_age_hours)));
  if (!s.notify.empty()) {
    const std::string problem = quoted_for_sh(log + "/last_problem.env");
    out += job("notify", name + "-notify",
               after.substr(1) + "\"afternotok:$plan?afternotok:$work?afternotok:$finish\" " + common("notify", "%j"),
               fmt::format("{}{}export BLOCKRAND_REGION={} BLOCKRAND_STATE=failed BLOCKRAND_REASON={}\n"
                           "{}{}\n",
                           enter,
                           s.notify_given ? std::string()
                                          : fmt::format("# What ran to its end has told its problem itself.\n"
                                                        "[ ! {} -nt {}/slurm-night ] || exit 0\n",
                                                        problem, quoted_for_sh(log)),
                           region, quoted_for_sh("a job of the night did not end well: see slurm-*.txt in " + log),
                           s.notify_given ? fmt::format("if [ -r {0} ]; then . {0}; fi\n", problem) : std::string(),
                           s.notify));
  }
  out += "echo \"submitted: plan $plan, work $work, finish $finish\"\n";
  return {{name + ".sh", out}};
}

std::vector<ScheduleFile> kubernetes_files(const Schedule& s) {
  if (s.shards > 1 && s.notify_given && !s.notify.empty())
    throw base::UsageError(
        "--notify with --shards: a Kubernetes job of several pods has no end that a command could wait for. Alert on "
        "blockrand_last_success_timestamp_seconds or kube_job_status_failed (docs/operations.md).");
  const std::string name = kubernetes_name(s.name);
  const std::string out = fmt::format(
      "# blockrand: the region {0} every night. kubectl apply -f FILE; a night at once: kubectl create job {0}-now "
      "--from=cronjob/{0}\n"
      "# The region is the volume, at /regions/{0} of the pods: paths in region.toml must be such as are there, and "
      "its input "
      "or\n# replication bring the data. {1}\n{2}---\n{3}---\n{4}",
      name, s.shards > 1 ? "All pods write the volume: it must be ReadWriteMany." : "One pod writes the volume.",
      config_map(s, name), volume_claim(s, name), cron_job(s, name));
  return {{name + ".yaml", out}};
}

}  // namespace blockrand::cli
