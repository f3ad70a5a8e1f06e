// SPDX-License-Identifier: MIT
#include "cluster.h"

#include <netinet/in.h>
#include <pwd.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <random>
#include <sstream>

#include "farm_test.h"
#include "program.h"

namespace afterglow::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMunge = 0, kController = 1, kFirstNode = 2;  // programs of the supervisor

/// A program of Debian's packages; daemons lie where users do not look for them.
std::string program_of(const std::string& name) {
  for (const char* folder : {"/usr/sbin", "/usr/bin", "/sbin", "/usr/local/sbin"})
    if (access((fs::path(folder) / name).c_str(), X_OK) == 0) return (fs::path(folder) / name).string();
  return {};
}

/// Ports of the loopback address that nobody listens at now.
std::vector<int> free_ports(std::size_t count) {
  std::vector<int> sockets, ports;
  for (std::size_t i = 0; i < count; ++i) {
    const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(file, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(getsockname(file, reinterpret_cast<sockaddr*>(&address), &size), 0);
    sockets.push_back(file);
    ports.push_back(ntohs(address.sin_port));
  }
  for (const int file : sockets) close(file);
  return ports;
}

void write_key(const fs::path& file) {
  std::random_device random;
  std::ofstream out(file, std::ios::binary);
  for (int i = 0; i < 1024; ++i) out.put(static_cast<char>(random()));
  out.close();
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
}

std::string user_name() {
  const passwd* entry = getpwuid(getuid());
  return entry ? entry->pw_name : "root";
}

std::string config_text(const fs::path& folder) {
  const auto ports = free_ports(1 + Cluster::kNodes);
  const std::string at = folder.string() + "/", user = user_name();
  std::ostringstream out;
  out << "ClusterName=test\nSlurmctldHost=localhost(127.0.0.1)\nSlurmUser=" << user << "\nSlurmdUser=" << user
      << "\nAuthType=auth/munge\nCredType=cred/munge\n"
      // A task that begins again waits as long as its old credential lives.
      << "AuthInfo=socket=" << at << "munge.sock,cred_expire=5\n"
      << "SlurmctldPort=" << ports[0] << "\nStateSaveLocation=" << at << "state\nSlurmdSpoolDir=" << at << "%n\n"
      << "SlurmctldPidFile=" << at << "slurmctld.pid\nSlurmdPidFile=" << at << "%n.pid\n"
      << "SlurmctldLogFile=" << at << "slurmctld.log\nSlurmdLogFile=" << at << "%n.log\n"
      << "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nJobAcctGatherType=jobacct_gather/none\n"
      << "AccountingStorageType=accounting_storage/none\nSelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\n"
      << "SlurmdParameters=config_overrides\nCommunicationParameters=NoInAddrAny\nSwitchType=switch/none\n"
      << "MpiDefault=none\nReturnToService=2\nInactiveLimit=0\nSlurmdTimeout=4\nKillWait=5\nMinJobAge=300\n"
      << "PreemptType=preempt/partition_prio\nPreemptMode=REQUEUE\nJobRequeue=1\nMaxArraySize="
      << Cluster::kLargestArray << "\nSchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1\n";
  for (int node = 1; node <= Cluster::kNodes; ++node)
    out << "NodeName=n" << node << " NodeAddr=127.0.0.1 NodeHostname=localhost CPUs=1 Port=" << ports[node] << "\n";
  out << "PartitionName=farm Nodes=ALL Default=YES PriorityTier=1 State=UP\n"
      << "PartitionName=urgent Nodes=ALL PriorityTier=10 State=UP\n";
  return out.str();
}

Outcome ask(const std::string& config, const std::string& program, const std::vector<std::string>& words) {
  RunOptions options;
  options.program = program;
  options.environment["SLURM_CONF"] = config;
  return run_program(words, options);
}

int number_in_file(const fs::path& file) {
  int number = 0;
  std::ifstream(file) >> number;
  return number;
}

}  // namespace

int parent_of(int process) {
  std::stringstream text;
  text << std::ifstream("/proc/" + std::to_string(process) + "/stat").rdbuf();
  const std::string status = text.str();
  const auto end = status.rfind(')');
  return end == std::string::npos || status.size() < end + 4 ? 0 : std::atoi(status.c_str() + end + 4);
}

std::vector<int> family_of(int process) {
  std::vector<int> family{process};
  for (std::size_t i = 0; i < family.size(); ++i) {
    std::error_code ec;
    for (fs::directory_iterator it("/proc", ec), end; !ec && it != end; it.increment(ec))
      if (const int other = std::atoi(it->path().filename().c_str()); other > 0 && parent_of(other) == family[i])
        family.push_back(other);
  }
  return family;
}

std::string Cluster::missing() {
  for (const char* name : {"munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel"})
    if (program_of(name).empty()) return std::string("there is no ") + name + " (Debian: slurm-wlm, munge)";
  return {};
}

Cluster::Cluster(const fs::path& folder) : folder_(folder) {
  fs::create_directories(folder_ / "state");
  fs::permissions(folder_, fs::perms(0755));
  for (int node = 1; node <= kNodes; ++node) fs::create_directory(folder_ / ("n" + std::to_string(node)));
  write_key(folder_ / "key");
  std::ofstream(folder_ / "slurm.conf") << config_text(folder_);
  const std::string at = folder_.string() + "/";
  std::vector<std::vector<std::string>> programs{
      {program_of("munged"), "--foreground", "--force", "--key-file=" + at + "key", "--socket=" + at + "munge.sock",
       "--pid-file=" + at + "munge.pid", "--log-file=" + at + "munge.log", "--seed-file=" + at + "munge.seed"},
      {program_of("slurmctld"), "-D", "-c", "-f", config()}};
  for (int node = 1; node <= kNodes; ++node)
    programs.push_back({program_of("slurmd"), "-D", "-f", config(), "-N", "n" + std::to_string(node)});
  supervisor_ = std::make_unique<Supervisor>(programs);
  supervisor_->start(kMunge);
  up_ = wait_until([&] { return fs::exists(folder_ / "munge.sock"); });
  for (std::size_t program = kController; program < programs.size(); ++program) supervisor_->start(program);
  up_ = up_ && wait_until([&] {
          const Outcome nodes = ask(config(), "sinfo", {"--noheader", "--Node", "--partition=farm", "--format=%t"});
          return nodes.out == "idle\nidle\nidle\nidle\n";
        });
}

Cluster::~Cluster() = default;

std::string Cluster::logs() const {
  std::string out;
  for (const char* name : {"munge.log", "slurmctld.log", "n1.log"}) {
    std::stringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    const std::string whole = text.str();
    out += std::string(name) + ":\n" + whole.substr(whole.size() > 4000 ? whole.size() - 4000 : 0);
  }
  return out;
}

void Cluster::kill_node(const std::string& node) const {
  const int daemon = number_in_file(folder_ / (node + ".pid"));
  ASSERT_GT(daemon, 1);
  // slurmstepd leaves its parent; its words name the node.
  std::vector<int> doomed = family_of(daemon);
  std::error_code ec;
  for (fs::directory_iterator it("/proc", ec), end; !ec && it != end; it.increment(ec)) {
    const int process = std::atoi(it->path().filename().c_str());
    std::stringstream words;
    words << std::ifstream(it->path() / "environ").rdbuf();
    const bool here = words.str().find("SLURM_CONF=" + config()) != std::string::npos;
    if (process > 0 && here && words.str().find("SLURMD_NODENAME=" + node) != std::string::npos)
      for (int one = process; one > 1; one = parent_of(one)) {
        std::string name;
        std::getline(std::ifstream("/proc/" + std::to_string(one) + "/comm"), name);
        if (name != "slurmstepd" && one != process) break;
        doomed.push_back(one);
      }
  }
  // All stand still first: slurmstepd must not tell of the task's end, as a machine without power would not.
  for (const int process : doomed) kill(process, SIGSTOP);
  for (const int process : doomed) kill(process, SIGKILL);
}

void Cluster::start_node(const std::string& node) const {
  supervisor_->start(kFirstNode + static_cast<std::size_t>(node.back() - '1'));
}

}  // namespace afterglow::test
