// Where the steps of tests are made: on the processor, or on a graphics card.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "feldspar/lab/run_test.hpp"

namespace feldspar {

struct DeviceUse {
    std::function<std::unique_ptr<StepDevice>()> open;  ///< a device for one test; empty: the processor
    double memory_bytes = 0.0;                          ///< of the device
    bool where_possible = false;  ///< tests that the device does not know run on the processor, and a note says so
};

/// What opens the device of a test; empty: it runs on the processor.
/// @param note  told if the test goes to the processor because the device does not know it
/// @throws InputError that says what of the test the device does not know, or that it is too large, unless the device is to be
/// used where possible
std::function<std::unique_ptr<StepDevice>()> opener_for(const TestSetup& setup, const DeviceUse& use,
                                                        const std::function<void(const std::string&)>& note);

}  // namespace feldspar
