// Records of tests as arrays and dictionaries.
#include "feldspar/output/results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "feldspar/base/error.hpp"
#include "feldspar/lab/quantities.hpp"
#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/event_columns.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/test_fields.hpp"
#include "feldspar/output/user_units.hpp"
#include "types.hpp"

namespace feldspar::python {
namespace {

using R = const PyResult&;

py::object table(const py::list& columns) { return py::module_::import("feldspar.tables").attr("Table")(columns); }

void add_column(py::list& columns, const std::string& name, const std::string& unit, const std::string& meaning,
                const py::object& values) {
    columns.append(py::make_tuple(name, unit, meaning, values));
}

// The columns of a file.
template <class Columns, class Row>
py::object file_table(const Columns& of_file, const std::vector<Row>& rows) {
    py::list columns;
    for (const auto& column : of_file) {
        const auto values = [&]<class Number>(Number) -> py::object {
            py::array_t<Number> array(static_cast<py::ssize_t>(rows.size()));
            for (std::size_t i = 0; i < rows.size(); ++i) array.mutable_data()[i] = static_cast<Number>(column.value(rows[i]));
            return array;
        };
        add_column(columns, column.name, column.unit, column.meaning, column.whole ? values(std::int64_t{}) : values(double{}));
    }
    return table(columns);
}

py::object history(R r) { return file_table(history_columns(*r.result), r.result->history); }

// Views of the rows themselves.
py::object history_si(R r) {
    const std::vector<HistoryRow>& rows = r.result->history;
    const py::capsule owner = keeper(r.result);
    py::list columns;
    const auto add = [&](const char* name, const char* unit, const char* meaning, auto HistoryRow::*member) {
        add_column(columns, name, unit, meaning, view_member(rows, rows.empty() ? nullptr : &(rows.front().*member), owner));
    };
    static_assert(sizeof(long long) == sizeof(std::int64_t));
    add("step", "1", "step of the phase", &HistoryRow::step);
    add("platen_displacement", "m", "approach of the platens", &HistoryRow::platen_displacement_m);
    add("axial_strain", "1", "from the platens", &HistoryRow::axial_strain);
    add("axial_strain_gauge", "1", "from the gauge, the central half of the specimen", &HistoryRow::axial_strain_gauge);
    add("lateral_strain_gauge", "1", "from the gauge; negative when the specimen widens", &HistoryRow::lateral_strain_gauge);
    add("axial_stress", "Pa", "mean of both platens over the section of the test", &HistoryRow::axial_stress_Pa);
    add("stress_top", "Pa", "the top platen alone", &HistoryRow::stress_top_Pa);
    add("stress_bottom", "Pa", "the bottom platen alone", &HistoryRow::stress_bottom_Pa);
    add("sigma3", "Pa", "lateral pressure", &HistoryRow::sigma3_Pa);
    add("cracks_tensile", "1", "contact points broken in tension so far", &HistoryRow::cracks_tensile);
    add("cracks_shear", "1", "contact points broken in shear so far", &HistoryRow::cracks_shear);
    add("residual", "1", "sum of the unbalanced forces over the platen force", &HistoryRow::residual);
    add("residual_median", "1", "the same with the median body's unbalanced force times the number of bodies as sum",
        &HistoryRow::residual_median);
    add("platen_speed", "m/step", "closing speed of the platens (dynamic numerics: m/s)", &HistoryRow::platen_speed);
    add("kinetic_deviation", "J", "kinetic energy of the motion that departs from the loading motion",
        &HistoryRow::kinetic_deviation);
    add("stage", "1", "number of the stage, from 1; 0 in a test without stages", &HistoryRow::stage);
    const auto add_energy = [&](const char* name, const char* meaning, double EnergyLedger::*member) {
        add_column(columns, name, "J", meaning,
                   view_member(rows, rows.empty() ? nullptr : &(rows.front().energy.*member), owner));
    };
    add_energy("energy_external", "work of the platens and the lateral pressure", &EnergyLedger::external);
    add_energy("energy_elastic_start", "put in by the computed elastic start", &EnergyLedger::elastic_start);
    add_energy("energy_rate_control", "work of the velocity correction when the rate changes", &EnergyLedger::rate_control);
    add_energy("energy_elastic_grains", "elastic, in the grains", &EnergyLedger::elastic_grains);
    add_energy("energy_elastic_contacts", "elastic, in the contacts", &EnergyLedger::elastic_contacts);
    add_energy("energy_fracture", "dissipated by fracture", &EnergyLedger::fracture);
    add_energy("energy_friction", "dissipated by friction", &EnergyLedger::friction);
    add_energy("energy_damping", "dissipated by numerical damping", &EnergyLedger::damping);
    add_energy("energy_kinetic", "kinetic", &EnergyLedger::kinetic);
    return table(columns);
}

py::object cracks(R r) {
    const std::vector<Crack>& list = r.result->cracks;
    const py::capsule owner = keeper(r.result);
    py::list columns;
    const auto add = [&](const char* name, const char* unit, const char* meaning, auto Crack::*member) {
        add_column(columns, name, unit, meaning, view_member(list, list.empty() ? nullptr : &(list.front().*member), owner));
    };
    const auto add_points = [&](const char* name, const char* unit, const char* meaning, Vec2 Crack::*member) {
        add_column(columns, name, unit, meaning,
                   view(list.empty() ? nullptr : &(list.front().*member).x, {static_cast<py::ssize_t>(list.size()), 2},
                        {sizeof(Crack), sizeof(double)}, owner));
    };
    static_assert(sizeof(CrackMode) == sizeof(int));
    add("step", "1", "step at which the bond broke", &Crack::step);
    add("axial_strain", "1", "then", &Crack::axial_strain);
    add("axial_stress", "Pa", "then", &Crack::axial_stress_Pa);
    add_column(columns, "mode", "1", "0 tensile, 1 shear",
               view_member(list, list.empty() ? nullptr : reinterpret_cast<const int*>(&list.front().mode), owner));
    add("grain_a", "1", "number of the one grain", &Crack::grain_a);
    add("grain_b", "1", "number of the other grain; that of a plate is negative", &Crack::grain_b);
    add("contact", "1", "number of the contact in the initial assembly", &Crack::contact);
    add("point", "1", "contact point within the contact", &Crack::point);
    add_points("place", "m", "of the contact point, undeformed: x, y", &Crack::place);
    add_points("from", "m", "begin of its share of the grain edge, undeformed: x, y", &Crack::from);
    add_points("to", "m", "end of its share of the grain edge, undeformed: x, y", &Crack::to);
    add("area", "m2", "of the contact point", &Crack::area_m2);
    add("energy", "J", "dissipated at this point until it broke", &Crack::energy_J);
    add_points("normal", "1", "from grain a to grain b, when it was recorded: x, y", &Crack::normal);
    add("opening", "m", "along the normal, when it was recorded", &Crack::opening_m);
    add("slip", "m", "of grain b across the normal, when it was recorded", &Crack::slip_m);
    return table(columns);
}

py::object events(R r) { return file_table(event_columns(), r.result->emission.events); }

py::dict emission(R r) {
    const AcousticEmission& e = r.result->emission;
    py::dict d;
    d["events"] = events(r);
    d["radius_mm"] = 1e3 * e.radius_m;
    d["window_steps"] = e.window_steps;
    d["b_value"] = number_or_none(e.b_value.b);
    d["b_value_error"] = number_or_none(e.b_value.error);
    d["completeness"] = number_or_none(e.b_value.completeness);
    d["fractal_dimension"] = number_or_none(e.fractal_dimension);
    return d;
}

// Numbers of some groups, by their names with user units.
py::dict quantities(R r, const std::set<QuantityGroup>& groups, bool others = false) {
    py::dict d;
    for (const TestQuantity& quantity : test_quantities()) {
        if ((groups.count(quantity.group) > 0) == others || !quantity.tests.contains(r.result->test.kind)) continue;
        const double value = quantity.value(*r.result);
        const py::str name(quantity.unit.user_name(quantity.name));
        switch (quantity.place.form) {
            case QuantityForm::real:
                d[name] = number_or_none(value * quantity.unit.factor);
                break;
            case QuantityForm::whole:
                d[name] = static_cast<std::int64_t>(value);
                break;
            case QuantityForm::yes_no:
                d[name] = value == 1.0;
                break;
        }
    }
    return d;
}

const std::set<QuantityGroup> evidence_groups{QuantityGroup::evidence, QuantityGroup::repeats, QuantityGroup::balance};
const std::set<QuantityGroup> cost_groups{QuantityGroup::steps, QuantityGroup::bookkeeping, QuantityGroup::cost};
const std::set<QuantityGroup> energy_groups{QuantityGroup::energies};

std::set<QuantityGroup> not_of_rock() {
    std::set<QuantityGroup> all = evidence_groups;
    all.insert(cost_groups.begin(), cost_groups.end());
    all.insert(energy_groups.begin(), energy_groups.end());
    return all;
}

py::list stages(R r) {
    py::list list;
    for (const StageRecord& stage : r.result->stages) {
        py::dict d;
        d["kind"] = name(stage.kind);
        d["first_row"] = stage.first_row;
        d["last_row"] = stage.last_row;
        d["ended"] = stage.ended;
        list.append(d);
    }
    return list;
}

py::list cycles(R r) {
    py::list list;
    for (const CycleProperties& c : r.result->properties.cycles) {
        py::dict d;
        d["first_stage"] = c.first_stage;
        d["last_stage"] = c.last_stage;
        d["sigma3_MPa"] = number_or_none(c.sigma3_Pa * MPa);
        d["peak_stress_MPa"] = number_or_none(c.peak_stress_Pa * MPa);
        d["strain_at_peak"] = number_or_none(c.peak_strain);
        d["reloading_modulus_GPa"] = number_or_none(c.reloading_modulus_Pa * GPa);
        d["unloading_modulus_GPa"] = number_or_none(c.unloading_modulus_Pa * GPa);
        d["permanent_axial_strain"] = number_or_none(c.permanent_axial_strain);
        d["permanent_lateral_strain"] = number_or_none(c.permanent_lateral_strain);
        d["permanent_volumetric_strain"] = number_or_none(c.permanent_volumetric_strain);
        d["damage_omega"] = number_or_none(c.damage);
        d["dissipated_J"] = c.dissipated_J;
        d["cracks"] = c.cracks;
        list.append(d);
    }
    return list;
}

py::list gauges(R r) {
    py::list list;
    for (const GaugeSpec& gauge : r.result->gauges) {
        py::dict d;
        d["name"] = gauge.name;
        d["unit"] = unit_of(gauge).name;
        d["meaning"] = gauge.meaning;
        list.append(d);
    }
    return list;
}

void save(R r, const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw OutputError(fmt::format("the directory '{}' cannot be made: {}", folder, error.message()));
    const std::string stem = test_stem(*r.result);
    const std::filesystem::path path(folder);
    for (const std::string& file : {"history-" + stem + ".csv", "events-" + stem + ".csv", stem + ".pvd"})
        if (std::filesystem::exists(path / file))
            throw InputError({.key = "directory"},
                             fmt::format("'{}' is there already, and would be lost", (path / file).string()),
                             "another directory");
    const RunDirectory directory = RunDirectory::open(path);
    const Provenance provenance = collect_provenance("import feldspar", r.result->threads);
    write_history_csv(directory, *r.result, provenance);
    write_events_csv(directory, *r.result);
    write_paraview(directory, fields_of(*r.result));
}

void export_paraview(const std::string& archive, const std::string& folder) {
    write_paraview(RunDirectory::open(folder), read_archive(archive));
}

// Fields at one moment, which live in their result.
struct PySnapshot {
    std::shared_ptr<const TestResult> result;
    std::size_t number;
    const Snapshot& get() const { return result->snapshots[number]; }
};
using N = const PySnapshot&;

py::list list_in_MPa(const std::vector<double>& values_Pa) {
    py::list list;
    for (const double value : values_Pa) list.append(number_or_none(value * MPa));
    return list;
}

}  // namespace

PySpecimen PyResult::specimen() const { return with_phases(result->specimen, result->grain, result->contact, result->rock); }

py::dict properties_of(const PropertySummary& summary) {
    std::vector<std::pair<UserQuantity, const PropertyStatistics*>> ordered;
    for (const auto& [key, statistics] : summary.values) ordered.emplace_back(user_quantity(key), &statistics);
    std::ranges::stable_sort(ordered, {}, [](const auto& entry) { return entry.first.rank; });
    py::dict all;
    for (const auto& [quantity, statistics] : ordered) {
        py::dict d;
        d["median"] = number_or_none(statistics->median * quantity.factor);
        d["minimum"] = number_or_none(statistics->minimum * quantity.factor);
        d["maximum"] = number_or_none(statistics->maximum * quantity.factor);
        d["unit"] = quantity.unit;
        d["label"] = quantity.label;
        d["seeds"] = statistics->seeds;
        py::list values;
        for (const double value : statistics->values) values.append(number_or_none(value * quantity.factor));
        d["values"] = values;
        all[py::str(quantity.name)] = d;
    }
    return all;
}

py::dict envelope_of(const PropertySummary& summary) {
    py::list fits;
    for (const EnvelopeFit& fit : summary.fits) {
        py::dict d;
        d["seed"] = fit.seed;
        d["cohesion_MPa"] = number_or_none(fit.cohesion_Pa * MPa);
        d["friction_angle_deg"] = number_or_none(fit.friction_angle_deg);
        d["UCS_measured_MPa"] = number_or_none(fit.UCS_measured_Pa * MPa);
        d["UCS_fitted_MPa"] = number_or_none(fit.UCS_fitted_Pa * MPa);
        d["hoek_brown_mi"] = number_or_none(fit.hoek_brown_mi);
        d["hoek_brown_UCS_MPa"] = number_or_none(fit.hoek_brown_UCS_Pa * MPa);
        d["sigma3_MPa"] = list_in_MPa(fit.sigma3_Pa);
        d["sigma1_MPa"] = list_in_MPa(fit.sigma1_Pa);
        fits.append(d);
    }
    py::list shear;
    for (const ShearFit& fit : summary.shear_fits) {
        py::dict d;
        d["seed"] = fit.seed;
        d["cohesion_MPa"] = number_or_none(fit.cohesion_Pa * MPa);
        d["friction_angle_deg"] = number_or_none(fit.friction_angle_deg);
        d["normal_stress_MPa"] = list_in_MPa(fit.normal_Pa);
        d["shear_strength_MPa"] = list_in_MPa(fit.peak_Pa);
        shear.append(d);
    }
    py::dict all;
    all["method"] = summary.envelope_method;
    all["fits"] = fits;
    all["shear_fits"] = shear;
    return all;
}

void bind_results(py::module_& m) {
    py::class_<PySnapshot>(m, "Snapshot",
                           "Fields at one moment of a test, on the grain mesh of its specimen. Stresses are compression "
                           "positive. Arrays are views of the result.")
        .def_property_readonly(
            "label", [](N s) { return s.get().label; }, "\"start\", \"first-crack\", \"peak\", \"end\" or \"load-<n>\".")
        .def_property_readonly(
            "step", [](N s) { return s.get().step; }, "Step of the loading.")
        .def_property_readonly(
            "axial_strain", [](N s) { return s.get().axial_strain; }, "Then, a pure number.")
        .def_property_readonly(
            "axial_stress", [](N s) { return s.get().axial_stress_Pa; }, "Then, Pa.")
        .def_property_readonly(
            "displacement", [](N s) { return view_points(s.get().displacement_m, keeper(s.result)); },
            "Of each node: shape (n, 2), m.")
        .def_property_readonly(
            "stress_xx", [](N s) { return view(s.get().stress_xx_Pa, keeper(s.result)); }, "Of each triangle, Pa.")
        .def_property_readonly(
            "stress_yy", [](N s) { return view(s.get().stress_yy_Pa, keeper(s.result)); }, "Of each triangle, Pa.")
        .def_property_readonly(
            "stress_xy", [](N s) { return view(s.get().stress_xy_Pa, keeper(s.result)); }, "Of each triangle, Pa.")
        .def_property_readonly(
            "damage", [](N s) { return view(s.get().damage, keeper(s.result)); },
            "Of each triangle: the largest damage of the contact points on its grain edge, 0 ... 1.")
        .def_property_readonly(
            "cracks", [](N s) { return s.get().cracks; }, "So many of the first cracks of the result are there then.")
        .def_property_readonly(
            "crack_opening", [](N s) { return view(s.get().crack_opening_m, keeper(s.result)); },
            "Of each of these cracks, m; > 0 open.")
        .def("__repr__", [](N s) { return fmt::format("<feldspar.Snapshot '{}' at step {}>", s.get().label, s.get().step); });

    py::class_<PyResult>(m, "Result",
                         R"(What one test has left: histories, cracks, fields, acoustic emission, properties, verdict.

Compression is positive, as in rock mechanics; a tension test runs negative; strengths are positive magnitudes.)")
        .def_property_readonly(
            "kind", [](R r) { return name(r.result->test.kind); }, "The test method.")
        .def_property_readonly(
            "name", [](R r) { return test_name(r.result->test); },
            "The test as files call it: its method, or the name of a custom test.")
        .def_property_readonly(
            "title", [](R r) { return title(r.result->variant, r.result->test); }, "The test in words: \"biaxial at 4 MPa\".")
        .def_property_readonly(
            "variant", [](R r) { return r.result->variant; }, "The job's variant; empty if it has none.")
        .def_property_readonly(
            "seed", [](R r) { return r.result->seed; }, "Seed of the packing.")
        .def_property_readonly(
            "sigma3_MPa", [](R r) { return r.result->test.sigma3_Pa * MPa; },
            "Pressure on the sides, or the normal stress of a shear test, MPa.")
        .def_property_readonly(
            "specimen", [](R r) { return r.specimen(); }, "The specimen of the test.")
        .def_property_readonly("history", &history,
                               "The history with the columns of the CSV files, whose names tell the units (axial_stress_MPa): a "
                               "Table of new arrays.")
        .def_property_readonly("history_si", &history_si,
                               "The history in SI units: a Table of read-only views of the record itself, without copies.")
        .def_property_readonly("cracks", &cracks,
                               "The bonds that broke, in the order in which they broke, SI units: a Table of read-only views.")
        .def_property_readonly(
            "snapshots",
            [](R r) {
                py::list list;
                for (std::size_t i = 0; i < r.result->snapshots.size(); ++i) list.append(PySnapshot{r.result, i});
                return list;
            },
            "Fields at chosen moments, in their order: start, first crack, some of the loading, peak, end.")
        .def(
            "snapshot",
            [](R r, const std::string& label) {
                std::string known;
                for (std::size_t i = 0; i < r.result->snapshots.size(); ++i) {
                    if (r.result->snapshots[i].label == label) return PySnapshot{r.result, i};
                    known += (known.empty() ? "" : ", ") + r.result->snapshots[i].label;
                }
                throw InputError({.key = "label"}, fmt::format("the result has no fields of '{}'", label), known);
            },
            py::arg("label"), "The fields with this label. Raises InputError with the labels that there are.")
        .def_property_readonly(
            "emission", &emission,
            R"(Acoustic emission: a dictionary with events (a Table, SI units), radius_mm and window_steps (within which cracks join an event), b_value, b_value_error, completeness (the
smallest magnitude that counts) and fractal_dimension; None where there are too few events.)")
        .def_property_readonly(
            "properties", [](R r) { return quantities(r, not_of_rock(), true); },
            "What a laboratory would report, by names that tell the units (strength_MPa, E_GPa, nu, sigma_ci_crack_volume_MPa "
            "...); None where the test does not define it.")
        .def_property_readonly(
            "evidence", [](R r) { return quantities(r, evidence_groups); },
            "Evidence that the test was quasi-static: estimated error of the strength, residuals, imbalance; pure numbers unless "
            "the name tells a unit.")
        .def_property_readonly(
            "energies", [](R r) { return quantities(r, energy_groups); }, "The energy balance at the end, J.")
        .def_property_readonly(
            "costs", [](R r) { return quantities(r, cost_groups); },
            "Steps, passages of the strength, wall time (wall_s), time of a step (ms_per_step) and bookkeeping.")
        .def_property_readonly(
            "grade", [](R r) { return std::string(1, r.result->evidence.grade); },
            "A: the strength is quasi-static to about 0.5 %; B: to about 2 %; C: not shown.")
        .def_property_readonly(
            "verdict", [](R r) { return r.result->evidence.verdict; }, "The grade in a sentence that says what to do.")
        .def_property_readonly(
            "remarks", [](R r) { return r.result->properties.remarks; }, "Sentences that a reader of the numbers must know.")
        .def_property_readonly(
            "stop_reason", [](R r) { return r.result->stop_reason; }, "Why the test ended, in words.")
        .def_property_readonly(
            "interrupted", [](R r) { return r.result->interrupted; }, "Whether the user ended it.")
        .def_property_readonly(
            "steps", [](R r) { return r.result->steps; }, "Steps of the loading, those of earlier passages too.")
        .def_property_readonly("stages", &stages,
                               "The stages that the test went through: kind, first_row and last_row in the history, and why it "
                               "ended; empty for a test without stages.")
        .def_property_readonly(
            "cycles", &cycles,
            "Of a test that unloads, each cycle's moduli, permanent strains and damage, by names that tell the units.")
        .def_property_readonly("gauges", &gauges, "The gauges of the test: name, unit of its column in history, meaning.")
        .def_property_readonly(
            "length", [](R r) { return r.result->length_m; }, "Strain is the loading motion over this length, m.")
        .def_property_readonly(
            "section", [](R r) { return r.result->section_m2; }, "Stress is the load over this section, m2.")
        .def("save", &save, py::arg("directory"),
             "Writes history and events as CSV and the fields for ParaView into a directory. Raises InputError if a file is "
             "there already, OutputError.")
        .def("__repr__", [](R r) {
            return fmt::format("<feldspar.Result: {}, seed {}, {:.4g} MPa, grade {}, {} cracks>",
                               title(r.result->variant, r.result->test), r.result->seed,
                               r.result->properties.peak_stress_Pa * MPa, r.result->evidence.grade, r.result->cracks.size());
        });

    m.def("export_paraview", &export_paraview, py::arg("archive"), py::arg("directory"),
          "Writes the fields of a test's archive for ParaView into a directory that is there, as `feldspar export`. Raises "
          "InputError if the archive cannot be read, OutputError.");
    m.def(
        "summarise",
        [](const std::vector<PyResult>& results) {
            std::vector<TestResult> list;
            for (const PyResult& r : results) list.push_back(*r.result);
            const PropertySummary summary = summarise(list);
            return py::make_tuple(properties_of(summary), envelope_of(summary));
        },
        py::arg("results"), R"(Properties of the rock over the packings of these results, and its strength envelopes.

Returns two dictionaries. Properties: name with unit to median, minimum, maximum, unit, label, seeds and values of each packing. Envelopes: method (a sentence), fits (one a packing: cohesion_MPa,
friction_angle_deg, hoek_brown_mi, sigma3_MPa, sigma1_MPa ...) and shear_fits.)");
}

}  // namespace feldspar::python
