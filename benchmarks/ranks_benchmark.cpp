// What a step costs each of several ranks, and what they tell each other: as threads of this program, or by MPI (mpirun -n 2
// ranks_benchmark). Waiting costs no processor time in the first case, so that its figures hold on a busy machine too.
#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <mutex>
#include <string>
#include <vector>

#include "benchmarks/granite.hpp"
#include "feldspar/base/stopwatch.hpp"
#include "feldspar/ranks/ranked_steps.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar::benchmarks {
namespace {

constexpr int kBlock = 10;  // steps, as between two records

struct Cost {
    double wall_ms = 0.0, cpu_ms = 0.0;  // of a block: the least of all
    RankTraffic traffic;
};

double thread_cpu_s() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// @param ranks  null: one program, without ranks
Cost measure(const Granite& granite, int threads, int blocks, Communicator* ranks) {
    Assembly assembly = const_cast<Granite&>(granite).assembly();
    StepSettings settings = const_cast<Granite&>(granite).settings();
    Cost cost{1e9, 1e9, {}};
    std::unique_ptr<StepDevice> device;
    if (ranks != nullptr) device = open_ranks(*ranks, &cost.traffic);
    settings.device = device.get();
    Team team(threads);
    PlatenWork work;
    for (int block = 0; block < blocks; ++block) {
        const auto start = std::chrono::steady_clock::now();
        const double cpu = thread_cpu_s();
        advance(assembly, team, settings, 0, kBlock, work);
        cost.cpu_ms = std::min(cost.cpu_ms, 1e3 * (thread_cpu_s() - cpu));
        cost.wall_ms = std::min(cost.wall_ms, 1e3 * seconds_since(start));
    }
    return cost;
}

void report(const std::string& who, const Cost& cost) {
    fmt::print("{:28} {:9.3f} {:9.3f}", who, cost.wall_ms / kBlock, cost.cpu_ms / kBlock);
    if (cost.traffic.steps > 0) {
        const auto steps = static_cast<double>(cost.traffic.steps), blocks = static_cast<double>(cost.traffic.blocks);
        fmt::print(" {:9.1f} {:9.2f} {:9.3f} {:8.1f} {:8.1f}", 1e-3 * cost.traffic.bytes_in_steps / steps,
                   1e-6 * cost.traffic.bytes_in_blocks / blocks, cost.traffic.own_part,
                   100.0 * cost.traffic.exchange_s / cost.traffic.all_s, 100.0 * cost.traffic.gather_s / cost.traffic.all_s);
    }
    fmt::print("\n");
    std::fflush(stdout);
}

int run(int argc, char** argv) {
    double scale = 1.0;
    int blocks = 20, threads = 1;
    std::vector<int> sizes{2, 4};
    std::string grains = "flexible";
    CLI::App app("What a step costs each of several ranks");
    app.add_option("--scale", scale, "of the paper's specimen, whose grains keep their size");
    app.add_option("--blocks", blocks, "of ten steps");
    app.add_option("--threads", threads, "of each rank");
    app.add_option("--ranks", sizes, "as threads of one program");
    app.add_option("--grains", grains)->check(CLI::IsMember({"flexible", "rigid"}));
    CLI11_PARSE(app, argc, argv);

    const auto here = communicator_here();
    const auto make = [&] {
        return Granite(grains == "rigid" ? GrainKind::rigid : GrainKind::flexible, Load::uniaxial, scale,
                       FELDSPAR_BENCHMARK_CACHE);
    };
    if (!here->first()) (void)here->from_first({});  // the packing is there by then
    const Granite granite = make();
    if (here->first()) (void)here->from_first({});
    const auto head = [] {
        fmt::print("{:28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8}\n", "", "ms a step", "cpu ms", "kB a step", "MB a block",
                   "points", "told %", "left %");
    };
    if (!here->alone()) {
        const Cost own = measure(granite, threads, blocks, here.get());
        if (here->first()) {
            head();
            report(fmt::format("{} ranks, {} threads each", here->size(), threads), own);
        }
        return 0;
    }
    head();
    report(fmt::format("one program, {} threads", threads), measure(granite, threads, blocks, nullptr));
    for (const int size : sizes) {
        std::mutex mutex;
        in_one_process(size, [&](Communicator& ranks) {
            const Cost own = measure(granite, threads, blocks, &ranks);
            const std::lock_guard lock(mutex);
            report(fmt::format("rank {} of {}, {} threads", ranks.rank(), size, threads), own);
        });
    }
    return 0;
}

}  // namespace
}  // namespace feldspar::benchmarks

int main(int argc, char** argv) {
    try {
        return feldspar::benchmarks::run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "ranks_benchmark: {}\n", error.what());
        return 1;
    }
}
