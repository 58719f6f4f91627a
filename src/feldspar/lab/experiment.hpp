// A test under way: the body between its platens, the settings of its step and the account of its energy.
#pragma once

#include <memory>

#include "feldspar/base/parallel.hpp"
#include "feldspar/lab/elastic_start.hpp"
#include "feldspar/lab/gauges.hpp"
#include "feldspar/lab/run_test.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/model/assembly.hpp"
#include "feldspar/step/step.hpp"

namespace feldspar {

/// Platen speed of the paper's own numerics, m a step, unless the user gives one (docs/decisions: loading rate).
inline constexpr double kPaperSpeed = 6.25e-9;

/// Elastic constants of the specimen that the start reckons with until it has measured them.
struct ElasticGuess {
    double E_Pa = 0.0;
    double nu = 0.0;
};

/// How far dead loads have been brought up on a body with the real law.
struct Ramp {
    long long step = 0;
    double already = 0.0;   ///< share that acts at its beginning
    double travel_m = 0.0;  ///< loading motion at the first damage of the elastic body, where that is known
};

/// What changes in the course of a test, beside its record: a copy of it is a state to which the test may go back.
struct ExperimentState {
    Assembly assembly;
    StepSettings settings{};
    ElasticGuess elastic_guess{};
    double mass_factor = 0.0;      ///< of the scaled masses; 0 with real masses
    double omega2 = 0.0;           ///< largest omega^2 dt^2 of the initial state
    double omega2_bound = 4.0;     ///< its limit
    double travel_time = 0.0;      ///< of a wave over the length, units of dt
    double platen_travel_m = 0.0;  ///< loading motion since the start
    int stage = 0;                 ///< number of the one under way, from 1; 0 without stages
    double axial_stiffness = 0.0;  ///< N per m of platen travel, of the intact body (an estimate until the elastic start)
    long long step = 0;
    bool stepped = false;  ///< the velocities are those of a step that was made, not set since
    long long preparation_steps = 0;
    PlatenWork platen_work{};
    double elastic_start_J = 0.0;
    double rate_control_J = 0.0;
    bool computed_start = false;  ///< the elastic phase was passed over in closed form
    Array<Vec2> full_weight{};    ///< of each node, N; empty without gravity
    double dead_load_N = 0.0;     ///< what presses and weighs in all, beside the loading; 0 of a confined specimen, whose platens
                                  ///< bear the pressure too
    double weight_start_J = 0.0;  ///< work of gravity before the account of the energy begins
    HistoryRow consolidated{};    ///< the state under dead loads, when the loading starts
    Ramp ramp{};
};

class TestKeeping;

/// Everything that the stages of a test share. Each stage (prepare, load) is a function of its own.
struct Experiment : ExperimentState {
    Experiment(const TestSetup& setup, const RunControl& control);

    const TestSetup& setup;
    const TestMethod& method;
    const RunControl& control;
    TestKeeping* keeping = nullptr;  ///< keeps the state of the test, and brings it back; may be null
    Team team;
    StrainGauge gauge;
    Gauges gauges;  ///< of the method

    double length_m = 0.0;    ///< strain = loading motion / length (MethodBuild)
    double section_m2 = 0.0;  ///< stress = load / section
    double direction = 1.0;   ///< +1 compression, -1 tension
    std::vector<StageGroup>
        stages;  ///< of the method or the job, then those that an observer orders; empty: it loads until the test ends

    ExperimentState& state() { return *this; }
    const ExperimentState& state() const { return *this; }

    /// Whether the test is to end here. Of several ranks the first decides.
    bool stopped() const {
        const bool here = control.stop != nullptr && control.stop->load();
        return control.agree ? control.agree(here) : here;
    }
    bool confined() const { return is_confined(setup.test); }  ///< a pressure acts on the sides, and first on all
    bool has_dead_loads() const;                               ///< pressures or gravity act before the loading starts
    /// Pressure on the sides of a confined specimen, Pa; 0 of others.
    double confining_Pa() const {
        return method.specimen.confined && !assembly.dead_loads.empty() ? assembly.dead_loads.front().pressure_Pa : 0.0;
    }
    /// Lets all dead loads act with a share of what is given.
    void set_dead_loads(double share);
    /// Work of gravity since the body was unloaded, J. @param since  at the displacements of so long ago, by the present
    /// velocities
    double weight_work(double since = 0.0) const;
    /// Compression positive. @param load_N  positive where the specimen resists the loading
    double stress(double load_N) const { return direction * load_N / section_m2 + 0.0; }  // no minus zero

    /// Sets the loading mode of the nodes whose motion fixtures impose.
    void impose_motion();

    /// Runs `count` steps with the present settings.
    void run(int count);

    /// Changes the speed of the loading, and with it the velocity of the whole body by dv B; books the work.
    void change_speed(double speed);

    /// Changes what a fixture does per unit of the loading motion (Assembly::fixtures), and with it the velocity of its nodes;
    /// books the work.
    void change_motion(std::size_t fixture, Vec2 motion);
};

/// What a stage asks of the test and the specimen. @throws InputError
void require_stage(const Experiment& experiment, const StageSpec& stage);

/// Mean diameter of the contact circles of grains or inner particles, m.
double mean_body_diameter(const Assembly& assembly);

/// Damping, masses and time step as the numerics ask; refuses an unstable setting (@throws InputError).
void choose_step(Experiment& experiment);

/// From the unloaded body to the first moment of loading: elastic start (adaptive), consolidation (biaxial), initial velocities.
/// Keeps the state of the test while dead loads are brought up, and goes on from there; a computed start is made anew.
void prepare(Experiment& experiment);

class Recorder;

/// Loads until a stop rule, the user or a force that is not a number ends it (@throws NumericalError for the last). Keeps the
/// state of the test when it is due, and goes on from a kept one if there is one: the experiment is then in its base state
/// (@throws StateError if it is another test's).
void load(Experiment& experiment, Recorder& recorder, TestResult& result);

/// Loading steps that a test of this kind typically takes, for estimates of time only.
double typical_steps(const Experiment& experiment);

}  // namespace feldspar
