// The fast room: one step over packs (model/packs.hpp) by vector instructions. docs/performance.md tells what was measured.
//
// It computes what the readable stages of step/ compute, on the same arrays; those stay the reference, in tests and for what is
// loose:
//
//   contacts   each pack of contacts: reads from both lines how the sides move, moves its points, leaves in the lines what they
//   feel grains     each pack of grains: reads from its lines what the edges feel, adds the triangles, moves the nodes, writes
//   how the edges move rigid      each rigid body: sums the forces of its contacts, moves centre and turn, writes how it moves
//
// What makes it fast: a lane is a grain or a contact, so there is nothing to gather but a line of 64 bytes a side; a contact
// whose sides are linear velocity fields needs only the difference of the two fields, once for all its points; an intact point is
// linear, and only its two displacements are touched; a pack of grains stays in the first-level cache from its forces to its new
// fields.
//
// The same source is compiled for each instruction set; the program chooses when it runs.
#pragma once

#include <array>
#include <cstdint>

#include "feldspar/model/assembly.hpp"

namespace feldspar {

/// What a step does, as the kernels see it (step/step.hpp: StepSettings).
struct KernelStep {
    double dt = 1.0;
    bool local_damping = false;
    double alpha = 0.0;
    double viscous = 0.0;
    double speed = 0.0;
    bool unlimited = false;  ///< intact points stay elastic
    bool keep_forces =
        false;  ///< write the forces of nodes and of intact points: of the last step of a block, for what is read between steps
    long long step = 0;
};

/// A point that broke in a block of steps on a device (gpu/), which cannot call anybody.
struct BrokenPoint {
    std::int32_t state = 0;   ///< where its bond stands
    std::int32_t step = 0;    ///< of the block, from 0; times 4, plus the BondEvent
    double fracture_J = 0.0;  ///< what it had dissipated by then
};

/// The arrays of an assembly. Points (x, y) as pairs of doubles, lines of 64 bytes as 8 doubles.
struct KernelArrays {
    Assembly* assembly = nullptr;
    const GrainPack* grain_packs = nullptr;
    const PackForces* pack_forces = nullptr;
    ContactPack* contact_packs = nullptr;
    const RigidBody* rigid_bodies = nullptr;
    const BondLaw* laws = nullptr;  ///< by role
    LawForm own_form;               ///< of contacts with laws of their own
    LawConstants<const double*> own;
    const double *volumetric = nullptr, *deviatoric = nullptr;  ///< of the grains in packs; null where all are alike
    const double* weight = nullptr;                             ///< of the nodes; null without gravity
    const double *reference = nullptr, *inverse_mass = nullptr, *loading_mode = nullptr, *mass = nullptr;
    double *displacement = nullptr, *velocity = nullptr, *force = nullptr;
    double *un = nullptr, *us = nullptr, *Fn = nullptr, *Fs = nullptr, *max_un = nullptr, *max_us = nullptr, *damage = nullptr;
    double *fracture = nullptr, *friction = nullptr;
    const double *offset = nullptr, *tangent_x = nullptr, *tangent_y = nullptr, *normal_x = nullptr, *normal_y = nullptr,
                 *along = nullptr, *area = nullptr;
    const std::uint32_t *line_a = nullptr, *line_b = nullptr;
    const std::uint8_t *shared = nullptr, *bare = nullptr;
    const std::int32_t* more_of_rigid = nullptr;
    const double* scale = nullptr;
    SideLine* lines = nullptr;
    SlotForces* slots = nullptr;
    RigidForces* rigid_forces = nullptr;
    double* inverse_cross = nullptr;
    BodyWork* body_work = nullptr;
    std::int32_t line_of_first_body = 0, grain_pack_count = 0, contact_pack_count = 0, node_count = 0;
    double thickness = 0.0, D11 = 0.0, D12 = 0.0;
    /// Called when point `point` of contact `contact` breaks; may change its bond.
    void (*broke)(Assembly& assembly, int contact, int point, BondEvent event, long long step) = nullptr;

    // Of a device instead:
    BrokenPoint* broken = nullptr;          ///< what broke, in any order
    std::uint32_t* broken_count = nullptr;  ///< behind it: not 0 if any point was damaged already or became so
    const double* free_gap = nullptr;       ///< of each bond (ContactPoint); null: there are none

    explicit KernelArrays(Assembly& assembly);
    /// For kernels that write nothing.
    static KernelArrays to_read(const Assembly& assembly) { return KernelArrays(const_cast<Assembly&>(assembly)); }
};

/// Sums over all packs, J.
struct PackEnergies {
    double grains = 0.0;                           ///< elastic, in the triangles of packed grains
    std::array<double, contact_roles> contacts{};  ///< elastic, in the points of each material
    double fracture = 0.0, friction = 0.0;         ///< dissipated by all points
};

/// Sums over all free components of all nodes (lab/body_energy.hpp: Motion).
struct NodeSums {
    double kinetic = 0.0, deviation = 0.0, ahead_damping = 0.0;  ///< J
};

/// The stages for one instruction set. Ranges are of packs, or of bodies.
struct Kernels {
    const char* name;  ///< "avx512", "avx2", "portable"
    int width;         ///< lanes an instruction
    void (*contacts)(const KernelArrays&, const KernelStep&, int begin, int end);
    void (*grains)(const KernelArrays&, const KernelStep&, int begin, int end);
    void (*rigid)(const KernelArrays&, const KernelStep&, int begin, int end);
    void (*grain_lines)(const KernelArrays&, int begin, int end);  ///< writes the lines of the present state only
    void (*rigid_lines)(const KernelArrays&, int begin, int end);
    NodeSums (*node_sums)(const KernelArrays&, const KernelStep&);  ///< after a step
    void (*unbalanced)(const KernelArrays&, double* of_bodies);  ///< of each packed grain: sum of |F| over its free components, N
    PackEnergies (*energies)(const KernelArrays&,
                             double since);  ///< triangles at the displacements of `since` ago, by the present velocities
};

/// All that this program holds, the fastest first.
const std::array<const Kernels*, 3>& all_kernels();

/// Whether the processor knows its instructions.
bool is_supported(const Kernels& kernels);

/// The fastest that the processor supports, unless the environment variable FELDSPAR_KERNELS names another.
const Kernels& best_kernels();

extern const Kernels kernels_avx512, kernels_avx2, kernels_portable;

}  // namespace feldspar
