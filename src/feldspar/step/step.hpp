// One explicit step, stage by stage. What each stage reads and writes:
//
//   contact_forces     reads node displacements and velocities; writes contact points and slots
//   body_forces        reads slots; writes node forces, velocities, displacements, work of each body
//   reactions          reads node forces of the fixtures; writes nothing
//   find_contacts      (between steps) makes and drops frictional contacts, chooses the fall-back shape functions
//
// advance() runs both for a number of steps on a team, with a barrier after each stage. What stands in packs goes through the
// kernels of fast/, the rest, or all of it if so wanted, through the readable stages declared here. A specimen larger than the
// caches takes several steps in one sweep, band by band.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "feldspar/base/parallel.hpp"
#include "feldspar/fast/kernels.hpp"
#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// How free nodes are damped.
enum class Damping {
    local,  ///< a force alpha |F| against w = V - v B, component by component, where it takes energy: what moves like the loading
            ///< is not dragged. With B = 0 the paper's own, equations (2)-(3)
    viscous  ///< in proportion to the velocity: dynamic relaxation
};

enum class Strength { real, unlimited };  ///< unlimited: intact points stay elastic (the computed elastic start)

class StepDevice;

struct StepSettings {
    double dt = 1.0;  ///< 1 with scaled masses, else s
    Damping damping = Damping::viscous;
    double alpha = 0.7;    ///< local: 0 <= alpha < 1
    double viscous = 0.0;  ///< viscous: c, 1 per unit of time; 0: no damping
    Strength strength = Strength::real;
    double speed = 0.0;                        ///< v: loading motion per unit of time
    const Kernels* kernels = &best_kernels();  ///< of the packs; none: the readable stages only
    int sweep_steps = 0;                       ///< steps that a sweep over the bands takes (model/bands.hpp); 0: as many as pay
    StepDevice* device = nullptr;  ///< makes all steps, instead of the kernels and the readable stages; none: the processor
};

/// Work of the fixtures on the body, J, accumulated every step.
struct PlatenWork {
    double loading = 0.0;
};

/// Makes whole blocks of steps in another way than this processor alone: on a graphics card (gpu/), or with other ranks (ranks/).
/// Between blocks the assembly holds the whole state, as if the processor had made the steps.
class StepDevice {
public:
    StepDevice() = default;
    StepDevice(const StepDevice&) = delete;
    StepDevice& operator=(const StepDevice&) = delete;
    virtual ~StepDevice() = default;

    /// What advance() does. @throws InputError where it cannot: a part of the model that it does not know, too little memory
    virtual void advance(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count,
                         PlatenWork& work) = 0;
};

/// What the body opposes to the loading, N: positive where it resists.
struct Reactions {
    double loading = 0.0;  ///< of the fixtures that move, along their motions: the power that they give is this times the speed
    double rest =
        0.0;  ///< of those at rest, along the sum of these motions, without their part of dead loads: the same in equilibrium
};

/// Stage 1: relative velocity, law, forces of the contacts [begin, end). `step` is written into points that break.
void contact_forces(Assembly& assembly, IndexRange contacts, const StepSettings& settings, long long step);

/// Stage 2: gather, triangles, pressure, damping, velocity and displacement of the bodies [begin, end).
void body_forces(Assembly& assembly, IndexRange bodies, const StepSettings& settings);

/// Leaves in the node forces of a body what gravity does, or nothing.
void weigh(Assembly& assembly, const Body& body);

/// The pressures' forces on a body, before it moves, with the first half of their work; and after it has moved the second half.
void add_pressure(Assembly& assembly, const Body& body, BodyWork& work, double dt);
void finish_pressure_work(Assembly& assembly, const Body& body, BodyWork& work, double dt);

/// Stage 3: ordered sums.
Reactions reactions(const Assembly& assembly);
double loading_reaction(const Assembly& assembly);

/// Force of the body on one fixture, N, in the components that the fixture imposes.
Vec2 reaction(const Assembly& assembly, const Fixture& fixture);

/// The same, and of a plate that is free along its normal what presses it there.
Vec2 felt_by(const Assembly& assembly, const Fixture& fixture);

/// Sum of the pressures and the weight, N.
Vec2 dead_resultant(const Assembly& assembly);

/// Steps in several calls, between which nobody else changes nodes, bonds, contacts, platens or pressure: what a block of steps
/// has to look up before its first one is looked up once.
class StepSequence {
public:
    StepSequence(Assembly& assembly, Team& team) : assembly_(assembly), team_(team) {}

    /// `count` steps; accumulates the platens' work.
    void advance(const StepSettings& settings, long long first_step, int count, PlatenWork& work);

private:
    Assembly& assembly_;
    Team& team_;
    std::optional<KernelArrays> arrays_;  // once the packs are sorted out and their lines tell how everything moves
};

/// A sequence of one call.
void advance(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count, PlatenWork& work);

/// Forces at the present state without moving anything: one step of zero length.
void evaluate_forces(Assembly& assembly, Team& team, Strength strength);

/// Finds pairs of bodies that come to overlap without having a contact, and drops open broken ones.
class ContactFinder {
public:
    /// @param skin_m  pairs are looked for this far apart; contacts are dropped this far open
    ContactFinder(const Assembly& assembly, double skin_m);

    struct Changes {
        int made = 0;
        int dropped = 0;
        double kinetic_J = 0.0;  ///< gained because nodes became heavier (scaled masses only)
        double elastic_J = 0.0;  ///< that new contacts start with: they are found when bodies overlap already
    };
    /// To be called every few steps: looks for candidates again only when some body has moved by half the skin.
    /// @param mass_factor  factor of the scaled masses; 0 with real masses
    /// @throws NumericalError if a body's position is not a finite number
    Changes update(Assembly& assembly, double mass_factor);

    template <class Archive>
    void keep(Archive& archive) {
        auto& [skin, centres, candidates, overlapping, overlaps] = *this;
        archive(skin, centres, candidates, overlapping, overlaps);
    }

private:
    struct Candidate {
        int a, b;
        double rest_overlap_m;
    };
    void search(const Assembly& assembly);

    double skin_m_;
    std::vector<Vec2> centres_at_search_;
    std::vector<Candidate> candidates_;
    std::vector<std::array<int, 2>> overlapping_at_start_;  // sorted pairs that overlap without a contact from the start
    std::vector<double> rest_overlaps_m_;
};

struct ShapeChoice {
    int fallback_sides = 0;  ///< contact sides on the initial shape functions
    double kinetic_J = 0.0;  ///< gained because nodes became heavier (scaled masses only)
};

/// Chooses for each contact of flexible bodies between current and initial shape functions: the initial ones where any current
/// value departs from its initial one by more than 0.5. Where extrapolation makes a point stiffer than the scaled masses allow
/// for, the masses follow, so that the step stays stable. Looks at all contacts.
/// @param mass_factor  factor of the scaled masses; 0 with real masses, which stay
ShapeChoice choose_shape_functions(Assembly& assembly, double mass_factor);

/// The same for every few steps: looks again only at contacts that have moved by a fiftieth of their triangles' height since they
/// were looked at, and now and then at all of them, because grains may also roll on each other.
class ShapeWatch {
public:
    explicit ShapeWatch(const Assembly& assembly) { measure(assembly, 0); }
    ShapeChoice look(Assembly& assembly, double mass_factor);

    template <class Archive>
    void keep(Archive& archive) {
        auto& [looks, allowed, seen] = *this;
        archive(looks, allowed, seen);
    }

private:
    void measure(const Assembly& assembly, std::size_t first_contact);
    bool has_moved(const Assembly& assembly, const Contact& contact, std::size_t c) const;
    void remember(const Assembly& assembly, const Contact& contact);

    int looks_ = 0;
    std::vector<double> allowed_m_;  // of each contact
    std::vector<Vec2> seen_m_;       // of each point: un and us when it was looked at
};

}  // namespace feldspar
