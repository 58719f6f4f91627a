// That the calibration runs, on this machine and on several threads; how fast is its own affair.
#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/calibration.hpp"

namespace feldspar::benchmarks {
namespace {

TEST(Calibration, IsAPositiveRate) {
    const double rate = multiply_add_rate(1e-4);
    EXPECT_TRUE(std::isfinite(rate));
    EXPECT_GT(rate, 0.0);
    EXPECT_TRUE(vector_bits() == 128 || vector_bits() == 256 || vector_bits() == 512);
}

TEST(Calibration, RunsOnATeam) {
    Team team(2);
    const Rates rates = slowest_rates(team, 1e-4);
    EXPECT_GT(rates.multiply_add, 0.0);
    EXPECT_GT(rates.memory, 0.0);
}

}  // namespace
}  // namespace feldspar::benchmarks
