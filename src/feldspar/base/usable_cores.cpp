#include "feldspar/base/usable_cores.hpp"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace feldspar {
namespace {

namespace fs = std::filesystem;

int cores_of_affinity() {
    const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    // more cores than a cpu_set_t holds need a larger one, which the system call then asks for
    for (int most = std::max(all, 1024); most <= 1 << 20; most *= 2) {
        cpu_set_t* set = CPU_ALLOC(static_cast<std::size_t>(most));
        if (set == nullptr) break;
        const std::size_t size = CPU_ALLOC_SIZE(static_cast<std::size_t>(most));
        const bool known = sched_getaffinity(0, size, set) == 0;
        const int cores = known ? CPU_COUNT_S(size, set) : 0;
        CPU_FREE(set);
        if (known) return std::max(1, cores);
    }
    return all;
}

std::string first_line(const fs::path& file) {
    std::ifstream input(file);
    std::string line;
    std::getline(input, line);
    return line;
}

// The limits of a group and of those above it, as far as they can be seen: in a container the group is the root of what it sees.
double smallest_quota(const fs::path& mounted, const fs::path& group, bool version_1) {
    double cores = 1e9;
    for (fs::path place = group.relative_path();; place = place.parent_path()) {
        const fs::path at = mounted / place;
        const std::string text = version_1 ? first_line(at / "cpu.cfs_quota_us") + " " + first_line(at / "cpu.cfs_period_us")
                                           : first_line(at / "cpu.max");
        cores = std::min(cores, cores_of_quota(text).value_or(1e9));
        if (place.empty()) return cores;
    }
}

double cores_of_group() {
    double cores = 1e9;
    std::ifstream groups("/proc/self/cgroup");  // "0::/a/b" in version 2, "4:cpu,cpuacct:/a/b" in version 1
    for (std::string line; std::getline(groups, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",", group = line.substr(second + 1);
        if (controllers == ",,") cores = std::min(cores, smallest_quota("/sys/fs/cgroup", group, false));
        if (controllers.find(",cpu,") != std::string::npos)
            cores = std::min(cores, smallest_quota("/sys/fs/cgroup/cpu", group, true));
    }
    return cores;
}

}  // namespace

std::optional<double> cores_of_quota(const std::string& text) {
    std::istringstream words(text);
    double quota = 0.0, period = 0.0;
    if (!(words >> quota >> period) || quota <= 0.0 || period <= 0.0) return std::nullopt;  // "max 100000", "-1 100000", no file
    return quota / period;
}

int usable_cores() {
    const double share = std::max(1.0, std::floor(cores_of_group()));
    return static_cast<int>(std::min(share, static_cast<double>(cores_of_affinity())));
}

}  // namespace feldspar
