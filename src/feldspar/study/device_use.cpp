#include "feldspar/study/device_use.hpp"

#include "feldspar/base/error.hpp"
#include "feldspar/gpu/device.hpp"
#include "feldspar/lab/on_device.hpp"

namespace feldspar {

std::function<std::unique_ptr<StepDevice>()> opener_for(const TestSetup& setup, const DeviceUse& use, const std::function<void(const std::string&)>& note) {
    if (!use.open) return {};
    const CardNeeds needs = card_needs(setup, {});
    if (needs.not_ported.empty()) return use.open;
    if (!use.where_possible) throw InputError({.key = "--device"}, needs.not_ported, "cpu, or auto", "run this test on the processor");
    if (note) note("runs on the processor: " + needs.not_ported);
    return {};
}

}  // namespace feldspar
