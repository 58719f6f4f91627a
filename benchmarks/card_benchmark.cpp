// What a step costs on a graphics card: specimens of the paper's size to a million grains, and many of the paper's size at once,
// beside the processor's threads.
//
// A million grains are ten specimens of 100,000 side by side in one set of arrays: their packing alone would take longer than
// everything else here.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "benchmarks/granite.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/gpu/device.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_of(const std::function<void()>& work) {
    const Clock::time_point start = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class A>
void append(A& all, const A& one) {
    all.insert(all.end(), one.begin(), one.end());
}

// Flexible grains without plates, so many times side by side: what a step reads of them.
Assembly tiled(const Assembly& one, int times) {
    Assembly all = one;
    const auto nodes = one.nodes.count(), bodies = static_cast<int>(one.bodies.size()),
               contacts = static_cast<int>(one.contacts.size()), points = static_cast<int>(one.points.size());
    const auto states = static_cast<int>(one.bonds.un_m.size()), edges = static_cast<int>(one.packs.inverse_cross.size()),
               triangles = static_cast<int>(one.packs.scale.size());
    const std::size_t lanes = kMostLanes * one.packs.contacts.size();
    Packs& packs = all.packs;
    for (auto* lines : {&packs.line_a, &packs.line_b}) lines->resize(lanes);
    packs.shared.resize(static_cast<std::size_t>(edges));
    for (int t = 1; t < times; ++t) {
        for (Array<Vec2> Nodes::*array : {&Nodes::reference, &Nodes::displacement, &Nodes::velocity, &Nodes::force,
                                          &Nodes::inverse_mass, &Nodes::loading_mode})
            append(all.nodes.*array, one.nodes.*array);
        append(all.nodes.mass, one.nodes.mass);
        append(all.bodies, one.bodies);
        append(all.body_work, one.body_work);
        append(all.initial_shapes, one.initial_shapes);
        for (Contact contact : one.contacts) {
            contact.first_point += t * points;
            all.contacts.push_back(contact);
        }
        for (ContactPoint point : one.points) {
            point.state += t * states;
            all.points.push_back(point);
        }
        for (Array<double> Bonds::*array : {&Bonds::un_m, &Bonds::us_m, &Bonds::Fn_N, &Bonds::Fs_N, &Bonds::max_un_m,
                                            &Bonds::max_us_m, &Bonds::damage, &Bonds::fracture_J, &Bonds::friction_J})
            append(all.bonds.*array, one.bonds.*array);
        for (GrainPack pack : one.packs.grains) {
            pack.first_node += t * nodes;
            pack.first_edge += t * edges;
            pack.first_triangle += t * triangles;
            for (std::int32_t& grain : pack.grain) grain += t * bodies;
            packs.grains.push_back(pack);
        }
        append(packs.forces, one.packs.forces);
        append(packs.scale, one.packs.scale);
        append(packs.bare, one.packs.bare);
        packs.shared.resize(packs.shared.size() + static_cast<std::size_t>(edges));
        for (ContactPack pack : one.packs.contacts) {
            pack.first_contact += t * contacts;
            pack.first_state += t * states;
            packs.contacts.push_back(pack);
        }
        for (Array<double> Packs::*array : {&Packs::offset, &Packs::tangent_x, &Packs::tangent_y, &Packs::along, &Packs::area})
            append(packs.*array, one.packs.*array);
        for (Array<std::uint32_t> Packs::*lines : {&Packs::line_a, &Packs::line_b})
            for (std::size_t i = 0; i < lanes; ++i)
                (packs.*lines)
                    .push_back((one.packs.*lines)[i] +
                               static_cast<std::uint32_t>(t * edges) * static_cast<std::uint32_t>(sizeof(SideLine)));
        for (std::size_t f = 0; f < one.fixtures.size(); ++f)
            for (const int node : one.fixtures[f].nodes) all.fixtures[f].nodes.push_back(node + t * nodes);
    }
    for (auto* lines : {&packs.line_a, &packs.line_b}) lines->resize(lines->size() + kMostLanes * kFetchAhead, 0);
    packs.lines.resize(static_cast<std::size_t>(times) * static_cast<std::size_t>(edges));
    packs.inverse_cross.resize(packs.lines.size());
    all.slots.resize(2 * all.contacts.size());
    packs.bands.ranges = {{{0, static_cast<int>(packs.contacts.size())}, {}, {0, static_cast<int>(packs.grains.size())}, {}, {}}};
    packs.bands.window_bytes.clear();
    return all;
}

// A step alone: blocks of steps of two lengths, whose difference has no copies in it.
double step_on_card_s(Assembly& assembly, StepSettings settings, StepDevice& device, int steps) {
    settings.device = &device;
    Team team(1);
    PlatenWork work;
    const auto block = [&](int count) { return seconds_of([&] { advance(assembly, team, settings, 0, count, work); }); };
    block(50);
    double least = 1e9;
    for (int i = 0; i < 3; ++i) {
        const double one = block(50), many = block(50 + steps);
        least = std::min(least, (many - one) / steps);
    }
    return least;
}

double block_on_card_s(Assembly& assembly, StepSettings settings, StepDevice& device) {
    settings.device = &device;
    Team team(1);
    PlatenWork work;
    advance(assembly, team, settings, 0, 10, work);
    double least = 1e9;
    for (int i = 0; i < 5; ++i)
        least = std::min(least, seconds_of([&] {
                                    for (int k = 0; k < 10; ++k) advance(assembly, team, settings, 0, 10, work);
                                }) / 10.0);
    return least;
}

void report_size(const char* what, Assembly& assembly, const StepSettings& settings, int steps, bool blocks) {
    const auto device = open_card();
    const double step_s = step_on_card_s(assembly, settings, *device, steps);
    const double triangles = static_cast<double>(assembly.packs.scale.size());
    fmt::print("{:34} {:9.4f} ms a step  {:8.3g} triangles a second  {:6.2f} GB on the card", what, 1e3 * step_s,
               triangles / step_s, card_bytes(assembly) / 1e9);
    if (blocks) fmt::print("  {:.3f} ms a block of 10 steps with copies", 1e3 * block_on_card_s(assembly, settings, *device));
    fmt::print("\n");
    std::fflush(stdout);
}

// So many tests at once, each with a thread of its own that hands over blocks of 10, 50 or 1000 steps.
double steps_a_second(const Assembly& assembly, const StepSettings& settings, int tests, int block, double seconds, bool card) {
    std::atomic<bool> go = false, stop = false;
    std::atomic<int> ready = 0;
    std::atomic<long long> steps = 0;
    std::vector<std::thread> threads;
    for (int t = 0; t < tests; ++t)
        threads.emplace_back([&] {
            Assembly own = assembly;
            Team team(1);
            StepSettings how = settings;
            const std::unique_ptr<StepDevice> device = card ? open_card() : nullptr;
            how.device = device.get();
            PlatenWork work;
            advance(own, team, how, 0, block, work);
            ++ready;
            while (!go) std::this_thread::yield();
            while (!stop) {
                advance(own, team, how, 0, block, work);
                if (!stop) steps += block;
            }
        });
    while (ready < tests) std::this_thread::yield();
    go = true;
    const Clock::time_point start = Clock::now();
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    const double made = static_cast<double>(steps), elapsed = std::chrono::duration<double>(Clock::now() - start).count();
    stop = true;
    for (std::thread& thread : threads) thread.join();
    return made / elapsed;
}

int run(int argc, char** argv) {
    CLI::App app("What a step costs on a graphics card.");
    std::string packings = FELDSPAR_BENCHMARK_CACHE;
    double seconds = 2.0;
    int most = 1'000'000, tests = 132;
    app.add_option("--packings", packings, "folder in which packings are kept");
    app.add_option("--seconds", seconds, "of each measurement of many tests at once");
    app.add_option("--most", most, "grains of the largest specimen: 1630, 16000, 100000 or 1000000");
    app.add_option("--tests", tests, "at once");
    CLI11_PARSE(app, argc, argv);
    try {
        const DeviceProvenance card = card_here();
        fmt::print("{}, CUDA driver {}, compute capability {}, {} precision; {} threads beside it\n", card.card, card.driver,
                   card.capability, card.precision, std::thread::hardware_concurrency());
    } catch (const InputError& error) {
        fmt::print("skipped: {}\n", error.what());
        return 0;
    }
    Granite paper(GrainKind::flexible, Load::uniaxial, 1.0, packings);
    for (const State state : {State::elastic, State::breaking}) {
        paper.set(state);
        report_size(state == State::elastic ? "paper's size" : "the same, breaking", paper.assembly(), paper.settings(), 2000,
                    true);
    }
    for (const int block : {10, 50, 1000})
        for (const int count : {1, 16, tests}) {
            fmt::print("{:4} tests at once on the card, blocks of {:4}: {:9.0f} specimen-steps a second\n", count, block,
                       steps_a_second(paper.assembly(), paper.settings(), count, block, seconds, true));
            std::fflush(stdout);
        }
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    fmt::print("{:4} tests at once on the processor, blocks of 10: {:9.0f} specimen-steps a second\n", cores,
               steps_a_second(paper.assembly(), paper.settings(), cores, 10, seconds, false));
    if (most >= 16'000) {
        Granite granite(GrainKind::flexible, Load::uniaxial, std::sqrt(16'000.0 / 1630.0), packings);
        report_size("16,000 grains", granite.assembly(), granite.settings(), 500, true);
    }
    if (most >= 100'000) {
        Granite granite(GrainKind::flexible, Load::uniaxial, std::sqrt(100'000.0 / 1630.0), packings);
        for (const State state : {State::elastic, State::breaking}) {
            granite.set(state);
            report_size(state == State::elastic ? "100,000 grains" : "the same, breaking", granite.assembly(), granite.settings(),
                        200, state == State::elastic);
        }
        if (most >= 1'000'000) {
            granite.set(State::elastic);
            Assembly million = tiled(granite.assembly(), 10);
            report_size("1,000,000 grains", million, granite.settings(), 100, false);
        }
    }
    return 0;
}

}  // namespace
}  // namespace feldspar::benchmarks

int main(int argc, char** argv) { return feldspar::benchmarks::run(argc, argv); }
