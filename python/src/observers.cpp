#include "observers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/lab/grain_fields.hpp"
#include "feldspar/laws/plane_elasticity.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar::python {

// Everything is valid while the call lasts: `view_` is empty afterwards. Views of arrays have `owner_` as their base, so that one
// that is kept shows in its count of references.
class PyState {
public:
    PyState(const TestView& view, py::capsule owner) : view_(&view), owner_(std::move(owner)) {}
    const TestView& view() const {
        if (view_ == nullptr) throw py::value_error("the state of a test can be looked at during the callback only");
        return *view_;
    }
    const Assembly& assembly() const { return view().assembly; }
    const HistoryRow& row() const { return view().row(); }
    const py::capsule& owner() const { return owner_; }
    /// @return references to the owner of views that are left
    long end() {
        view_ = nullptr;
        const long left = static_cast<long>(owner_.ref_count());
        owner_ = py::capsule();
        return left;
    }
    TestOrders orders;

private:
    const TestView* view_;
    py::capsule owner_;
};

namespace {

// Steps at which a call is due: a test that has gone back is looked at again.
bool is_due(long long step, long long last, long long next) { return step >= next || step < last; }

py::array_t<double> stresses(const PyState& s) {
    const Assembly& a = s.assembly();
    const Specimen& specimen = *s.view().result.specimen;
    const std::size_t count = specimen.mesh.triangles.size();
    py::array_t<double> array({static_cast<py::ssize_t>(count), py::ssize_t{3}});
    auto at = array.mutable_unchecked<2>();
    py::ssize_t t = 0;
    const auto put = [&](const Mat2& stress) {
        at(t, 0) = -stress.xx;
        at(t, 1) = -stress.yy;
        at(t, 2) = -stress.xy;
        ++t;
    };
    if (!a.triangles.empty()) {  // flexible grains, in the order of the mesh
        for (int b = 0; b < static_cast<int>(a.bodies.size()); ++b)
            for (int i = a.bodies[static_cast<std::size_t>(b)].triangle_begin;
                 i < a.bodies[static_cast<std::size_t>(b)].triangle_end; ++i)
                put(cauchy_stress(a.elasticity_of(b),
                                  displacement_gradient(a.nodes.displacement, a.triangles[static_cast<std::size_t>(i)])));
    } else {
        const std::vector<Mat2> of_grains = grain_stresses(a, specimen);
        for (std::size_t g = 0; g < of_grains.size(); ++g)
            for (int i = specimen.mesh.triangle_begin[g]; i < specimen.mesh.triangle_begin[g + 1]; ++i) put(of_grains[g]);
    }
    return array;
}

py::array_t<double> mesh_displacement(const PyState& s) {
    const std::vector<Vec2> u = mesh_displacements(s.assembly(), *s.view().result.specimen, s.assembly().nodes.displacement);
    py::array_t<double> array({static_cast<py::ssize_t>(u.size()), py::ssize_t{2}});
    auto at = array.mutable_unchecked<2>();
    for (std::size_t i = 0; i < u.size(); ++i) {
        at(static_cast<py::ssize_t>(i), 0) = u[i].x;
        at(static_cast<py::ssize_t>(i), 1) = u[i].y;
    }
    return array;
}

py::dict gauges(const PyState& s) {
    py::dict d;
    const std::vector<GaugeSpec>& specs = s.view().gauges;
    for (std::size_t g = 0; g < specs.size() && g < s.row().gauges.size(); ++g) d[py::str(specs[g].name)] = s.row().gauges[g];
    return d;
}

py::dict pressures(const PyState& s) {
    py::dict d;
    for (const DeadLoad& load : s.assembly().dead_loads) d[py::str(load.name)] = load.pressure_Pa;
    return d;
}

py::dict fixtures(const PyState& s) {
    py::dict all;
    for (const Fixture& fixture : s.assembly().fixtures) {
        const Vec2 force = felt_by(s.assembly(), fixture);
        py::dict d;
        d["motion"] = py::make_tuple(fixture.motion.x, fixture.motion.y);
        d["force"] = py::make_tuple(force.x, force.y);
        all[py::str(fixture.name)] = d;
    }
    return all;
}

py::dict energy(const PyState& s) {
    const EnergyLedger& e = s.row().energy;
    py::dict d;
    d["external"] = e.external;
    d["elastic_start"] = e.elastic_start;
    d["rate_control"] = e.rate_control;
    d["elastic_grains"] = e.elastic_grains;
    d["elastic_contacts"] = e.elastic_contacts;
    d["fracture"] = e.fracture;
    d["friction"] = e.friction;
    d["damping"] = e.damping;
    d["kinetic"] = e.kinetic;
    return d;
}

py::array contact_bodies(const PyState& s) {
    const std::vector<Contact>& contacts = s.assembly().contacts;
    if (contacts.empty()) return py::array_t<std::int32_t>(std::vector<py::ssize_t>{0, 2});
    const Contact& first = contacts.front();
    const auto apart = reinterpret_cast<const char*>(&first.b.body) - reinterpret_cast<const char*>(&first.a.body);
    return view(&first.a.body, {static_cast<py::ssize_t>(contacts.size()), 2}, {sizeof(Contact), apart}, s.owner());
}

py::array contact_points(const PyState& s) {
    const std::vector<Contact>& contacts = s.assembly().contacts;
    if (contacts.empty()) return py::array_t<std::int32_t>(std::vector<py::ssize_t>{0, 2});
    const Contact& first = contacts.front();
    const auto apart = reinterpret_cast<const char*>(&first.points) - reinterpret_cast<const char*>(&first.first_point);
    return view(&first.first_point, {static_cast<py::ssize_t>(contacts.size()), 2}, {sizeof(Contact), apart}, s.owner());
}

// ------------------------------------------------------------------------------------------------------------------------ stages

// `until` and one of `at`, `by`, `beyond`, as a job's stages have them.
StageSpec moving(StageKind kind, const std::optional<std::string>& until, const py::object& at, const py::object& by,
                 const py::object& beyond) {
    StageSpec stage{.kind = kind};
    constexpr const char* keys[]{"at", "by", "beyond"};
    const py::object* given[]{&at, &by, &beyond};
    constexpr StageValue counts[]{StageValue::reached, StageValue::changed, StageValue::beyond};
    const auto how_many =
        std::count_if(std::begin(given), std::end(given), [](const py::object* value) { return !value->is_none(); });
    if (!until) {
        if (how_many > 0)
            throw InputError({.key = "until"}, "a value is given, and not of what", "until=\"stress\" and the like");
        if (kind == StageKind::unload) stage.end = StageEnd::stress;  // to nothing
        return stage;
    }
    const auto word = std::ranges::find_if(stage_ends, [&](StageEnd end) { return *until == name(end); });
    stage.end = word != stage_ends.end() ? *word : StageEnd::gauge;
    if (stage.end == StageEnd::gauge) stage.gauge = *until;
    if (stage.end == StageEnd::reversal) {
        if (kind == StageKind::unload)
            throw InputError({.key = "until"}, "the volumetric strain turns while a specimen is loaded", "Stage.load");
        if (how_many > 0) throw InputError({.key = "until"}, "until=\"reversal\" has no value", "leave at, by and beyond out");
        return stage;
    }
    if (how_many != 1)
        throw InputError({.key = "at"}, fmt::format("until=\"{}\" of what value", *until), "one of at, by and beyond");
    Dimension dimension = Dimension::fraction;
    if (stage.end == StageEnd::stress) dimension = Dimension::stress;
    if (stage.end == StageEnd::load) dimension = Dimension::force;
    for (int i = 0; i < 3; ++i) {
        if (given[i]->is_none()) continue;
        if (stage.end == StageEnd::gauge && py::isinstance<py::str>(*given[i]))
            throw InputError({.key = keys[i]}, "the value of a gauge is given as text", "a number in SI units");
        stage.value = quantity_of(*given[i], dimension, keys[i]);
        stage.counts = counts[i];
        const bool share = stage.end == StageEnd::share_of_peak;
        if (!std::isfinite(stage.value)) throw InputError({.key = keys[i]}, "is no number", "a finite number");
        if (share && stage.counts != StageValue::reached)
            throw InputError({.key = keys[i]}, "a share of the peak is a value itself", "at=0.8");
        if (share && !(stage.value > 0.0 && stage.value < 1.0))
            throw InputError({.key = keys[i]}, "is no share to which the load can fall", "greater than 0 and less than 1");
        if (stage.counts != StageValue::reached && !(stage.value > 0.0))
            throw InputError({.key = keys[i]}, "is no change", "greater than 0");
        if (kind == StageKind::unload && stage.counts == StageValue::beyond)
            throw InputError({.key = keys[i]}, "counts from where the last loading ended, and this stage unloads", "at or by");
        const bool of_load = stage.end == StageEnd::stress || stage.end == StageEnd::load;
        if (of_load && stage.counts == StageValue::reached && !(stage.value >= 0.0))
            throw InputError({.key = keys[i]}, "is beyond the unloaded specimen", "0 or more");
    }
    return stage;
}

PyStage hold(std::optional<double> travel_times) {
    if (travel_times && !(*travel_times > 0.0 && std::isfinite(*travel_times)))
        throw InputError({.key = "travel_times"}, fmt::format("{} travel times", *travel_times), "greater than 0");
    return {StageSpec{.kind = StageKind::hold, .travel_times = travel_times}};
}

PyStage confine(const py::object& sigma3, const std::string& fixture, const std::string& keep) {
    StageSpec stage{
        .kind = StageKind::confine, .sigma3_Pa = quantity_of(sigma3, Dimension::stress, "sigma3"), .fixture = fixture};
    if (!(stage.sigma3_Pa >= 0.0) || !std::isfinite(stage.sigma3_Pa))
        throw InputError({.key = "sigma3"}, "is no pressure that can act", "0 or more");
    const auto word = std::ranges::find_if(confine_keeps, [&](ConfineKeep k) { return keep == name(k); });
    if (word == confine_keeps.end())
        throw InputError({.key = "keep"}, fmt::format("'{}' is not one of the choices", keep), "motion, load");
    stage.keep = *word;
    return {stage};
}

std::string text_of(const PyStage& stage) {
    const StageSpec& s = stage.spec;
    if (s.kind == StageKind::hold)
        return s.travel_times ? fmt::format("hold for {:g} travel times", *s.travel_times) : "hold until at rest";
    if (s.kind == StageKind::confine) return fmt::format("confine at {:g} MPa", s.sigma3_Pa / 1e6);
    if (s.end == StageEnd::test) return std::string(name(s.kind)) + " until the test ends";
    const char* counts = s.counts == StageValue::reached ? "at" : s.counts == StageValue::changed ? "by" : "beyond";
    return fmt::format("{} until {} {} {:g}", name(s.kind), s.end == StageEnd::gauge ? s.gauge : name(s.end), counts, s.value);
}

}  // namespace

TestOrders PyObserver::look(const TestView& view) {
    const long long step = view.row().step;
    if (!is_due(step, last_, next_) && !view.stage_ended) return {};
    if (step < last_) next_ = step;  // it has gone back
    last_ = step;
    while (next_ <= step) next_ += every_;
    TestOrders orders;
    const bool done = caller_.call([&] {
        py::object state = py::cast(PyState(view, keeper(left_)));
        auto& held = state.cast<PyState&>();
        const auto end = [&]() -> long { return held.end(); };
        try {
            py::object answer = function_(state);
            if (answer.is(py::bool_(false)) && !held.orders.stop) held.orders.stop = "the callback has ended it";
        } catch (...) {
            (void)end();
            throw;
        }
        orders = held.orders;
        if (end() > 1)
            throw py::value_error(
                "a view of the state was kept beyond the callback, where what it looks at is gone: keep a copy "
                "(numpy.array(view))");
    });
    if (!done) orders.stop = "the callback has failed";
    return orders;
}

void PyObserver::leaves(Assembly&& assembly) noexcept { *left_ = std::move(assembly); }

void bind_observers(py::module_& m) {
    py::class_<PyStage>(
        m, "Stage",
        R"(What the loading does until an end is reached, in the words of a job's stages. Values are numbers in SI units, or text with a unit.)")
        .def_static(
            "load",
            [](const std::optional<std::string>& until, const py::object& at, const py::object& by, const py::object& beyond) {
                return PyStage{moving(StageKind::load, until, at, by, beyond)};
            },
            py::arg("until") = py::none(), py::kw_only(), py::arg("at") = py::none(), py::arg("by") = py::none(),
            py::arg("beyond") = py::none(),
            R"(The loading motion grows.

until: "stress" (Pa), "load" (N), "axial-strain", "lateral-strain", "share-of-peak", "reversal" (of the volumetric strain) or the name of a gauge (SI); None: until the test ends, or another stage is ordered.
at: the value itself; by: its change since the stage began; beyond: how far it goes beyond where the last loading ended. Raises InputError.)")
        .def_static(
            "unload",
            [](const std::optional<std::string>& until, const py::object& at, const py::object& by) {
                return PyStage{moving(StageKind::unload, until, at, by, py::none())};
            },
            py::arg("until") = py::none(), py::kw_only(), py::arg("at") = py::none(), py::arg("by") = py::none(),
            "The loading motion goes back; without `until` to no stress. Arguments as of load(). Raises InputError.")
        .def_static("hold", &hold, py::arg("travel_times") = py::none(),
                    "The loading motion is at rest for so many travel times of a wave over the specimen; None: until the "
                    "specimen is at rest, too. Raises InputError.")
        .def_static(
            "confine", &confine, py::arg("sigma3"), py::kw_only(), py::arg("fixture") = "", py::arg("keep") = "motion",
            R"(A pressure goes slowly to another value, Pa or text with a unit. fixture: whose; empty: all of the test. keep: "motion", the loading motion is at rest, or "load", it follows so that the axial
stress stays as it is. Raises InputError.)")
        .def_property_readonly(
            "kind", [](const PyStage& s) { return name(s.spec.kind); }, "\"load\", \"unload\", \"hold\" or \"confine\".")
        .def(
            "__eq__", [](const PyStage& a, const PyStage& b) { return a.spec == b.spec; }, py::is_operator())
        .def("__repr__", [](const PyStage& s) { return "<feldspar.Stage: " + text_of(s) + ">"; });

    using State = PyState;
    py::class_<State>(
        m, "State",
        R"(The state of a running test, which a callback looks at and from which it gives orders. Valid during the callback only.

Arrays are read-only views of what the test works on, without copies; one that is to be kept must be copied (numpy.array(view)). They have the signs of the inside: tension positive, a gap positive
when it is open. What is told of stresses and strains of the test as a whole is compression positive, as in results.)")
        .def_property_readonly(
            "step", [](const State& s) { return s.row().step; },
            "Step of the loading. Smaller than at the last call if the test has gone back to pass its strength more slowly.")
        .def_property_readonly(
            "passage", [](const State& s) { return s.view().passage; }, "Passages of the strength so far, this one included.")
        .def_property_readonly(
            "axial_strain", [](const State& s) { return s.row().axial_strain; }, "From the platens, a pure number.")
        .def_property_readonly(
            "lateral_strain", [](const State& s) { return s.row().lateral_strain_gauge; },
            "From the gauge in the middle, a pure number; < 0 when the specimen widens.")
        .def_property_readonly(
            "axial_stress", [](const State& s) { return s.row().axial_stress_Pa; }, "Pa.")
        .def_property_readonly(
            "sigma3", [](const State& s) { return s.row().sigma3_Pa; }, "Pressure on the sides, Pa.")
        .def_property_readonly(
            "cracks_tensile", [](const State& s) { return s.row().cracks_tensile; }, "Contact points broken in tension so far.")
        .def_property_readonly(
            "cracks_shear", [](const State& s) { return s.row().cracks_shear; }, "Contact points broken in shear so far.")
        .def_property_readonly(
            "residual", [](const State& s) { return s.row().residual_median; },
            "Unbalanced force of the typical body over the platen force, a pure number.")
        .def_property_readonly("energy", &energy, "The energy balance, J.")
        .def_property_readonly("gauges", &gauges, "Readings of the gauges by name, SI units.")
        .def_property_readonly("pressures", &pressures, "Pressure of each fixture that has one, Pa.")
        .def_property_readonly(
            "fixtures", &fixtures,
            "Of each fixture its motion per unit of the loading motion (x, y) and the force that it feels (x, y), N.")
        .def_property_readonly(
            "platen_travel", [](const State& s) { return s.view().travel_m; }, "Loading motion since the start, m.")
        .def_property_readonly(
            "platen_speed", [](const State& s) { return s.view().speed; },
            "Speed of the loading motion, m a step (dynamic numerics: m/s).")
        .def_property_readonly(
            "travel_time", [](const State& s) { return s.view().travel_time / s.view().time_step; },
            "Of a wave over the specimen, steps.")
        .def_property_readonly(
            "stage", [](const State& s) { return s.view().stage; },
            "Number of the stage under way, from 1; 0 in a test without stages.")
        .def_property_readonly(
            "stage_kind", [](const State& s) { return name(s.view().kind); }, "Kind of the stage under way.")
        .def_property_readonly(
            "stage_ended", [](const State& s) { return s.view().stage_ended; },
            "Why the stage under way ends with this state; None while it goes on. What comes next may then be ordered by "
            "begin().")
        .def_property_readonly(
            "node_places", [](const State& s) { return view_points(s.assembly().nodes.reference, s.owner()); },
            "Undeformed places of the nodes of all bodies: view, shape (n, 2), m. The order is that of the computation, not that "
            "of the grain mesh.")
        .def_property_readonly(
            "displacement", [](const State& s) { return view_points(s.assembly().nodes.displacement, s.owner()); },
            "Of the same nodes: view, shape (n, 2), m. The second node of a rigid body holds its rotation times its radius.")
        .def_property_readonly(
            "velocity", [](const State& s) { return view_points(s.assembly().nodes.velocity, s.owner()); },
            "Of the same nodes: view, shape (n, 2), m a step (dynamic numerics: m/s).")
        .def_property_readonly(
            "force", [](const State& s) { return view_points(s.assembly().nodes.force, s.owner()); },
            "On the same nodes, where it is kept (boundary and fixtures): view, shape (n, 2), N.")
        .def_property_readonly(
            "mesh_nodes", [](const State& s) { return view(s.assembly().node_of_mesh, s.owner()); },
            "Of each node of the grain mesh its number among these nodes: view; empty unless the grains are flexible.")
        .def("mesh_displacement", &mesh_displacement,
             "Displacement of each node of the specimen's grain mesh, whatever its grains are: a new array, shape (n, 2), m.")
        .def("stresses", &stresses,
             "Stress of each triangle of the specimen's grain mesh, xx, yy, xy, compression positive: a new array, shape (n, 3), "
             "Pa. Rigid grains have one stress a grain.")
        .def_property_readonly("contact_bodies", &contact_bodies,
                               "The two bodies of each contact: view, shape (n, 2). Bodies are the grains, or their inner "
                               "particles, then the plates.")
        .def_property_readonly("contact_points", &contact_points,
                               "First contact point of each contact, and how many it has: view, shape (n, 2).")
        .def_property_readonly(
            "point_bonds",
            [](const State& s) {
                const std::vector<ContactPoint>& p = s.assembly().points;
                return view_member(p, p.empty() ? nullptr : &p.front().state, s.owner());
            },
            "Of each contact point the number of its bond in the bond_... arrays: view.")
        .def_property_readonly(
            "point_areas",
            [](const State& s) {
                const std::vector<ContactPoint>& p = s.assembly().points;
                return view_member(p, p.empty() ? nullptr : &p.front().area_m2, s.owner());
            },
            "Area of each contact point: view, m2.")
        .def_property_readonly(
            "bond_damage", [](const State& s) { return view(s.assembly().bonds.damage, s.owner()); },
            "Of each bond, 0 intact ... 1 broken: view.")
        .def_property_readonly(
            "bond_opening", [](const State& s) { return view(s.assembly().bonds.un_m, s.owner()); },
            "Normal displacement of each bond: view, m; > 0 open.")
        .def_property_readonly(
            "bond_slip", [](const State& s) { return view(s.assembly().bonds.us_m, s.owner()); },
            "Shear displacement of each bond: view, m.")
        .def_property_readonly(
            "bond_normal_force", [](const State& s) { return view(s.assembly().bonds.Fn_N, s.owner()); },
            "Normal force of each bond: view, N; compression positive.")
        .def_property_readonly(
            "bond_shear_force", [](const State& s) { return view(s.assembly().bonds.Fs_N, s.owner()); },
            "Shear force of each bond: view, N.")
        .def(
            "stop",
            [](State& s, const std::string& reason) {
                (void)s.view();
                s.orders.stop = reason;
            },
            py::arg("reason") = "the callback has ended it", "Ends the test here.")
        .def(
            "begin",
            [](State& s, const PyStage& stage) {
                (void)s.view();
                s.orders.stage = stage.spec;
            },
            py::arg("stage"), R"(Begins a stage now, in place of the one under way and of all that were to follow it.

Of tests with stages only: those of a job, or those that run() was given `begins`.)")
        .def(
            "set_speed",
            [](State& s, const py::object& speed) {
                (void)s.view();
                s.orders.pace = speed.is_none() ? TestOrders::Pace::own : TestOrders::Pace::given;
                if (!speed.is_none()) s.orders.speed = speed.cast<double>();
            },
            py::arg("speed"),
            R"(Speed of the loading motion from now on, m a step (dynamic numerics: m/s); negative goes back; None: the test's own again. A stage that begins has its own.

With adaptive numerics the test no longer sees to it then that it stays quasi-static; its grade tells.)")
        .def(
            "set_pressure",
            [](State& s, const py::object& pressure, const std::string& fixture) {
                (void)s.view();
                s.orders.pressures.push_back({fixture, quantity_of(pressure, Dimension::stress, "pressure")});
            },
            py::arg("pressure"), py::arg("fixture") = "",
            "Pressure of a fixture from the next step on, Pa or text with a unit; without a name of all that have one. At once; "
            "a stage that confines changes it slowly.")
        .def(
            "set_motion",
            [](State& s, const std::string& fixture, const std::array<double, 2>& motion) {
                (void)s.view();
                s.orders.motions.push_back({fixture, {motion[0], motion[1]}});
            },
            py::arg("fixture"), py::arg("motion"),
            "What a fixture moves per unit of the loading motion (x, y) from the next step on; (0, 0) holds it.")
        .def("__repr__", [](const State& s) { return fmt::format("<feldspar.State at step {}>", s.row().step); });
}

}  // namespace feldspar::python
