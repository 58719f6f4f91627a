// The record keeps the best of all runs, processor by processor, and never stands in the way.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "benchmarks/calibration_record.hpp"

namespace feldspar::benchmarks {
namespace {

TEST(CalibrationRecord, KeepsTheBestOfAllRuns) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "feldspar-calibration-record";
    std::filesystem::remove_all(folder);
    const auto file = folder / "calibrations.json";
    EXPECT_EQ(record_calibrations(file, "one", {{1, 100.0}}), (BestCalibrations{{1, 100.0}}));
    EXPECT_EQ(record_calibrations(file, "one", {{1, 80.0}, {2, 70.0}}), (BestCalibrations{{1, 100.0}, {2, 70.0}}));
    EXPECT_EQ(record_calibrations(file, "one", {{1, 110.0}}), (BestCalibrations{{1, 110.0}}));
    EXPECT_EQ(record_calibrations(file, "another", {{1, 50.0}}), (BestCalibrations{{1, 50.0}}));
    std::ofstream(file) << "rubbish";
    EXPECT_EQ(record_calibrations(file, "one", {{1, 60.0}}), (BestCalibrations{{1, 60.0}}));
    std::ofstream(file) << R"({"one": [1, 2]})";
    EXPECT_EQ(record_calibrations(file, "one", {{1, 60.0}}), (BestCalibrations{{1, 60.0}}));
    EXPECT_EQ(record_calibrations(file / "no" / "folder.json", "one", {{1, 60.0}}), (BestCalibrations{{1, 60.0}}));
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace feldspar::benchmarks
