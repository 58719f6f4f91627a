// What this machine is, as far as it says so itself.
#include <fmt/format.h>
#include <sched.h>
#include <sys/utsname.h>

#include <filesystem>
#include <fstream>
#include <system_error>
#include <thread>

#include "benchmarks/calibration.hpp"
#include "benchmarks/measure.hpp"
#include "benchmarks/report.hpp"

namespace feldspar::benchmarks {
namespace {

std::string processor_name() {
    std::ifstream input("/proc/cpuinfo");
    for (std::string line; std::getline(input, line);) {
        const auto colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown processor";
}

// A container or a batch system may give fewer than there are.
int usable_cores() {
#if defined(__linux__)
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
    return static_cast<int>(std::thread::hardware_concurrency());
}

}  // namespace

double waited_seconds() {
    std::error_code failed;
    double nanoseconds = 0.0;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", failed)) {
        std::ifstream input(task.path() / "schedstat");  // time on a core, time waiting for one, number of turns
        double running = 0.0, waiting = 0.0;
        if (input >> running >> waiting) nanoseconds += waiting;
    }
    return 1e-9 * nanoseconds;
}

Machine this_machine() {
    Machine machine;
    machine.processor = processor_name();
    machine.vector_bits = vector_bits();
    machine.cores = usable_cores();
    utsname system{};
    if (uname(&system) == 0) machine.system = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
    return machine;
}

}  // namespace feldspar::benchmarks
