#include "feldspar/output/history_columns.hpp"

#include <array>
#include <string_view>

#include "feldspar/methods/method.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

namespace {

using Row = const HistoryRow&;

constexpr auto columns = std::to_array<HistoryColumn>({
    {"phase", "1", "0 isotropic consolidation, 1 elastic start (passed over in closed form), 2 loading", true,
     [](Row r) { return static_cast<double>(static_cast<int>(r.phase)); }},
    {"step", "1", "step of the phase", true, [](Row r) { return static_cast<double>(r.step); }},
    {"platen_displacement_mm", "mm", "approach of the platens", false, [](Row r) { return r.platen_displacement_m * 1e3; }},
    {"axial_strain", "1", "from the platens (Brazilian: approach of the plates / diameter)", false,
     [](Row r) { return r.axial_strain; }},
    {"axial_strain_gauge", "1", "from the gauge, the central half of the specimen", false,
     [](Row r) { return r.axial_strain_gauge; }},
    {"lateral_strain_gauge", "1", "from the gauge; negative when the specimen widens", false,
     [](Row r) { return r.lateral_strain_gauge; }},
    {"volumetric_strain_gauge", "1", "axial + lateral, from the gauges, in the plane; negative when the specimen dilates", false,
     [](Row r) { return r.axial_strain_gauge + r.lateral_strain_gauge; }},
    {"axial_stress_MPa", "MPa", "mean of both platens over the initial section (Brazilian: 2 P / (pi D t))", false,
     [](Row r) { return r.axial_stress_Pa * MPa; }},
    {"stress_top_MPa", "MPa", "the top platen alone", false, [](Row r) { return r.stress_top_Pa * MPa; }},
    {"stress_bottom_MPa", "MPa", "the bottom platen alone", false, [](Row r) { return r.stress_bottom_Pa * MPa; }},
    {"sigma3_MPa", "MPa", "lateral pressure", false, [](Row r) { return r.sigma3_Pa * MPa; }},
    {"cracks_tensile", "1", "contact points broken in tension so far", true,
     [](Row r) { return static_cast<double>(r.cracks_tensile); }},
    {"cracks_shear", "1", "contact points broken in shear so far", true,
     [](Row r) { return static_cast<double>(r.cracks_shear); }},
    {"residual", "1", "R*: sum of the unbalanced forces / platen force", false, [](Row r) { return r.residual; }},
    {"residual_median", "1", "the same with the median body's unbalanced force times the number of bodies as sum", false,
     [](Row r) { return r.residual_median; }},
    {"platen_speed", "m/step", "closing speed of the platens (dynamic numerics: m/s)", false,
     [](Row r) { return r.platen_speed; }},
    {"kinetic_deviation_J", "J", "kinetic energy of the motion that departs from the loading motion", false,
     [](Row r) { return r.kinetic_deviation; }},
    {"energy_external_J", "J", "work of the platens and the lateral pressure", false, [](Row r) { return r.energy.external; }},
    {"energy_elastic_start_J", "J", "put in by the computed elastic start", false, [](Row r) { return r.energy.elastic_start; }},
    {"energy_rate_control_J", "J", "work of the velocity correction when the rate changes", false,
     [](Row r) { return r.energy.rate_control; }},
    {"energy_elastic_grains_J", "J", "elastic, in the triangles", false, [](Row r) { return r.energy.elastic_grains; }},
    {"energy_elastic_contacts_J", "J", "elastic, in the contacts", false, [](Row r) { return r.energy.elastic_contacts; }},
    {"energy_fracture_J", "J", "dissipated by fracture", false, [](Row r) { return r.energy.fracture; }},
    {"energy_friction_J", "J", "dissipated by friction", false, [](Row r) { return r.energy.friction; }},
    {"energy_damping_J", "J", "dissipated by numerical damping", false, [](Row r) { return r.energy.damping; }},
    {"energy_kinetic_J", "J", "kinetic", false, [](Row r) { return r.energy.kinetic; }},
    {"energy_residual_J", "J", "what the balance leaves over", false, [](Row r) { return r.energy.residual(); }},
});

}  // namespace

std::span<const HistoryColumn> history_columns() { return columns; }

GaugeUnit unit_of(const GaugeSpec& gauge) {
    switch (gauge.kind) {
        case GaugeKind::displacement:
            return {"mm", 1e3};
        case GaugeKind::force:
            return {"kN", 1e-3};
        case GaugeKind::mean_stress:
        case GaugeKind::hole_stress:
            return {"MPa", 1e-6};
        case GaugeKind::energy:
            return {"J", 1.0};
        case GaugeKind::strain:
        case GaugeKind::mean_strain:
            break;
    }
    return {"1", 1.0};
}

std::vector<FileColumn> history_columns(const TestResult& result) {
    const bool strained_evenly = method_of(result.test).start.strained_evenly;
    std::vector<FileColumn> all;
    for (const HistoryColumn& column : columns)
        if (strained_evenly || !std::string_view(column.name).ends_with("_gauge"))
            all.push_back({column.name, column.unit, column.meaning, column.whole, column.value});
    for (FileColumn& column : all)
        if (!strained_evenly && column.name == "axial_strain")
            column.meaning = "loading motion over the length of the test";
        else if (!strained_evenly && column.name == "axial_stress_MPa")
            column.meaning = "load over the section of the test";
    for (std::size_t g = 0; g < result.gauges.size(); ++g) {
        const GaugeSpec& gauge = result.gauges[g];
        const GaugeUnit unit = unit_of(gauge);
        const std::string name = unit.name == std::string_view("1") ? gauge.name : gauge.name + "_" + unit.name;
        all.push_back({name, unit.name, gauge.meaning, false,
                       [g, unit](Row r) { return g < r.gauges.size() ? r.gauges[g] * unit.factor : 0.0; }});
    }
    if (!result.stages.empty())
        all.push_back({"stage", "1", "number of the stage of loading, from 1; 0 before the first", true,
                       [](Row r) { return static_cast<double>(r.stage); }});
    return all;
}

}  // namespace feldspar
