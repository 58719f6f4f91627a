// Acoustic events of a test as CSV.
#include <fmt/format.h>

#include <array>

#include "feldspar/output/csv_table.hpp"
#include "feldspar/output/event_columns.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {

std::span<const EventColumn> event_columns() {
    using E = const AcousticEvent&;
    static constexpr std::array columns{
        EventColumn{"first_step", "1", "loading step of its first crack", [](E e) { return static_cast<double>(e.first_step); },
                    true},
        EventColumn{"last_step", "1", "loading step of its last crack", [](E e) { return static_cast<double>(e.last_step); },
                    true},
        EventColumn{"axial_strain", "1", "from the platens, at its first crack", [](E e) { return e.axial_strain; }},
        EventColumn{"axial_stress_Pa", "Pa", "at its first crack", [](E e) { return e.axial_stress_Pa; }},
        EventColumn{"x_m", "m", "mean of its cracks, undeformed", [](E e) { return e.place.x; }},
        EventColumn{"y_m", "m", "mean of its cracks, undeformed", [](E e) { return e.place.y; }},
        EventColumn{"cracks", "1", "cracks in it", [](E e) { return static_cast<double>(e.cracks); }, true},
        EventColumn{"shear_cracks", "1", "of these in shear", [](E e) { return static_cast<double>(e.shear_cracks); }, true},
        EventColumn{"energy_J", "J", "dissipated by its cracks until they broke", [](E e) { return e.energy_J; }},
        EventColumn{"magnitude", "1", "of the energy (P65)", [](E e) { return e.magnitude; }},
        EventColumn{"moment_xx_Nm", "N m", "moment tensor (P66), opening positive", [](E e) { return e.moment_Nm.xx; }},
        EventColumn{"moment_xy_Nm", "N m", "moment tensor (P66)", [](E e) { return e.moment_Nm.xy; }},
        EventColumn{"moment_yy_Nm", "N m", "moment tensor (P66), opening positive", [](E e) { return e.moment_Nm.yy; }},
        EventColumn{"moment_magnitude", "1", "of the scalar moment (P67)", [](E e) { return e.moment_magnitude; }},
        EventColumn{"isotropy", "1", "R (P68): above 30 tensile, below -30 implosive, between shear",
                    [](E e) { return e.isotropy; }},
    };
    return columns;
}

void write_events_csv(const RunDirectory& directory, const TestResult& result) {
    const AcousticEmission& emission = result.emission;
    if (emission.events.empty()) return;
    std::string text = fmt::format(
        "# acoustic events of {}: cracks within {:.6g} m and {:.6g} steps of each other (P64)\n# format: feldspar events 1\n# "
        "signs: {}\n",
        test_stem(result), emission.radius_m, emission.window_steps, sign_convention);
    append_meanings(text, event_columns());
    append_csv(text, event_columns(), emission.events);
    directory.write_text("events-" + test_stem(result) + ".csv", text);
}

}  // namespace feldspar
