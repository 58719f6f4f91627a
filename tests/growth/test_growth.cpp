// Operations and memory of every stage, counted at two sizes: what a stage takes a grain must not depend on how many there are.
// A time would, on a shared machine; the number of basic blocks that a program goes through (CMakeLists.txt) does not.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <new>
#include <string>

#include "benchmarks/growth.hpp"
#include "tests/growth/all_pairs.hpp"

namespace {

struct Counted {
    long long blocks = 0;      // basic blocks
    long long bytes = 0;       // that are allocated now
    long long most_bytes = 0;  // at most, since it was set
};
Counted counted;

void* allocated(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    counted.bytes += static_cast<long long>(malloc_usable_size(memory));
    counted.most_bytes = std::max(counted.most_bytes, counted.bytes);
    return memory;
}

void release(void* memory) {
    if (memory != nullptr) counted.bytes -= static_cast<long long>(malloc_usable_size(memory));
    std::free(memory);
}

}  // namespace

// Every allocation of this program goes through these.
void* operator new(std::size_t size) { return allocated(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    const std::size_t step = static_cast<std::size_t>(alignment);
    return allocated(std::aligned_alloc(step, (size + step - 1) / step * step));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

// Called at the beginning of every basic block of what is counted.
extern "C" void __sanitizer_cov_trace_pc() { ++counted.blocks; }

namespace feldspar {
namespace {

constexpr int kSmall = 1000, kLarge = 8000;  // grains: an eighth, and still most grains away from the rim

/// What a stage takes a grain.
struct Cost {
    double blocks = 0.0;
    double bytes = 0.0;  // most, beyond what was there before
};
using Costs = std::map<std::string, Cost>;

Cost cost_of(double grains, const std::function<double()>& work) {
    const long long blocks = counted.blocks, bytes = counted.bytes;
    counted.most_bytes = counted.bytes;
    const double times = work();
    return {static_cast<double>(counted.blocks - blocks) / times / grains,
            static_cast<double>(counted.most_bytes - bytes) / grains};
}

struct Walked {
    Costs costs;
    double search_of_all = 0.0;  // basic blocks a grain of a search of all pairs
    double held_bytes = 0.0;     // a grain, of specimen and body
};

Walked walk(int grains) {
    Walked walked;
    const auto watch = [&](std::string_view stage, const std::function<double()>& work) {
        walked.costs[std::string(stage)] = cost_of(grains, work);
    };
    benchmarks::GrowingTest test(grains, 1, watch);
    test.set_up(watch);
    test.test(watch);
    const auto all_pairs = [&] { return std::max(1.0, 1e-9 * near_pairs_of_all(test.result().specimen->packing.centres, 1e-3)); };
    walked.held_bytes = (test.specimen_bytes() + test.assembly_bytes()) / grains;
    walked.search_of_all = cost_of(grains, all_pairs).blocks;
    return walked;
}

class Growth : public testing::Test {
protected:
    static void SetUpTestSuite() {
        small_ = new Walked(walk(kSmall));
        large_ = new Walked(walk(kLarge));
    }
    static void TearDownTestSuite() {
        delete small_;
        delete large_;
    }
    static Walked *small_, *large_;
};
Walked* Growth::small_ = nullptr;
Walked* Growth::large_ = nullptr;

// By how much a count a grain may grow from the small specimen to the large one, which has eight times as many grains: grains at
// the rim have fewer neighbours and contacts than others, and of the large specimen a third as many grains stand there. A
// logarithm, as of sorting, would grow by log 8000 / log 1000 = 1.30: what has one may be a small part of a stage only.
constexpr double kRim = 1.06;
// A crack looks at nine squares around it, in most of which a small specimen has no event: more cracks fill them, up to a bound.
constexpr double kSquares = 1.15;

double allowed(const std::string& stage) { return stage == "acoustic events" ? kSquares : kRim; }

std::string told(const std::string& stage, double small, double large) {
    return fmt::format("{}: {:.1f} a grain in {} grains, {:.1f} in {}", stage, small, kSmall, large, kLarge);
}

TEST_F(Growth, OperationsOfAGrainDoNotDependOnTheNumberOfGrains) {
    for (const auto& [stage, large] : large_->costs) {
        const double small = small_->costs.at(stage).blocks;
        RecordProperty(stage, fmt::format("{:.3f}", large.blocks / small));
        EXPECT_GT(small, 1.0) << stage << " is not counted";
        EXPECT_LE(large.blocks, allowed(stage) * small) << told(stage, small, large.blocks);
    }
}

// Arrays that double as they grow may stand anywhere between one and two times their items when they are largest.
TEST_F(Growth, MemoryOfAGrainDoesNotDependOnTheNumberOfGrains) {
    constexpr double kDoubling = 1.5;
    for (const auto& [stage, large] : large_->costs) {
        const double small = small_->costs.at(stage).bytes;
        RecordProperty("bytes of " + stage, fmt::format("{:.0f} {:.0f}", small, large.bytes));
        EXPECT_LE(large.bytes, kDoubling * small + 8.0) << told("bytes of " + stage, small, large.bytes);
    }
}

TEST_F(Growth, WhatHoldsASpecimenStaysBelowWhatItsNumberOfGrainsAsks) {
    EXPECT_LT(large_->held_bytes, 7.3e3) << "bytes a grain of specimen and body";
    EXPECT_LT(large_->costs.at("masses, largest eigenvalue").bytes, 600.0) << "bytes a grain beside them";
}

// These bounds find a stage that looks at all pairs: eight times as much a grain.
TEST_F(Growth, ASearchOfAllPairsIsNoticed) {
    EXPECT_GT(large_->search_of_all, 7.0 * small_->search_of_all);
    EXPECT_GT(small_->search_of_all, 100.0);
}

}  // namespace
}  // namespace feldspar
