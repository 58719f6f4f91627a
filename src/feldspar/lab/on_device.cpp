#include "feldspar/lab/on_device.hpp"

#include "feldspar/gpu/device.hpp"
#include "feldspar/lab/experiment.hpp"
#include "feldspar/ranks/share.hpp"

namespace feldspar {

CardNeeds card_needs(const TestSetup& setup, const RunControl& control) {
    const Experiment e(setup, control);
    return {not_ported(e.assembly), card_bytes(e.assembly)};
}

int most_ranks(const TestSetup& setup) {
    const RunControl control;
    return units_to_share(Experiment(setup, control).assembly);
}

}  // namespace feldspar
