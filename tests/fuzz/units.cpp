// A quantity as users write it. The first byte says of which dimension.
#include "feldspar/base/units.hpp"

#include <cmath>

#include "fuzz.hpp"

namespace feldspar::fuzz {

void units(std::string_view input) {
    if (input.empty()) return;
    const auto dimension =
        static_cast<Dimension>(static_cast<unsigned char>(input.front()) % (static_cast<unsigned>(Dimension::fraction) + 1));
    input.remove_prefix(1);
    read_or_refuse([&] {
        const double value = parse_quantity(input, dimension);
        if (!std::isfinite(value)) throw Fault("a quantity is not a finite number");
        if (parse_quantity(format_si(value, dimension), dimension) != value)
            throw Fault("a quantity that was written is read as another one");
    });
}

}  // namespace feldspar::fuzz
