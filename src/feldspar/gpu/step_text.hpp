// One step by the threads of a device. The same text is compiled for the card (cuda_backend.cu) and, as loops over the threads of
// a block, for the processor (emulation.cpp), so that tests need no card, and a card's bits can be held against those of a
// processor. Included by these two alone.
//
//     contacts   a thread is a contact: a lane of its pack; or a loose contact, by the readable stage
//     bodies     a thread is an edge of a grain, with the corner where it begins and the ring node behind it; or a rigid body; or
//     a plate reaction   one block: the work of the loading in the step behind
//
// What is done in a lane is the text of fast/pack_kernels.hpp. The edges of a grain give each other what they need in the memory
// of their block, between phases: a block of threads finishes a phase before any of it begins the next. Every sum is in a fixed
// order, whatever the size of the blocks.
#pragma once

#define FELDSPAR_LANES 1
#include "feldspar/fast/pack_kernels.hpp"
#include "feldspar/gpu/device_arrays.hpp"
#include "feldspar/step/one_body.hpp"
#include "feldspar/step/one_contact.hpp"

namespace feldspar {
namespace {

constexpr int kReactionThreads = 256;
constexpr int kSharedQuantities = 13;  // doubles that a thread of the grains' stage gives to its block

FELDSPAR_INLINE KernelStep step_number(const DeviceArrays& a, int k) {
    const BlockOfSteps& block = *a.block;
    KernelStep step = block.step;
    step.step = block.first + k;
    step.keep_forces = step.step == block.last;
    return step;
}

// ---------------------------------------------------------------------------------------------------------------- contacts

template <Frame frame, bool central, bool uneven>
FELDSPAR_INLINE void contact_of_pack(const DeviceArrays& a, const KernelStep& step, ContactPack& pack, int index, int lane) {
    const Chunk chunk{lane, 1};
    if constexpr (uneven) {
        if (pack.first_law >= 0) {
            if (pack.plain)
                contacts_of_chunk<frame, central, true, true>(a, step, pack, index, chunk);
            else
                contacts_of_chunk<frame, central, false, true>(a, step, pack, index, chunk);
            return;
        }
    }
    if (pack.plain)
        contacts_of_chunk<frame, central, true, false>(a, step, pack, index, chunk);
    else
        contacts_of_chunk<frame, central, false, false>(a, step, pack, index, chunk);
}

// @tparam rigid   whether the packs of rigid bodies are meant, or the others
// @tparam uneven  whether there are contacts with laws of their own
template <bool rigid, bool uneven>
FELDSPAR_INLINE void contact_thread(const DeviceArrays& a, const KernelStep& step, int thread) {
    const int index = thread / kMostLanes, lane = thread % kMostLanes;
    if (index >= a.contact_pack_count) return;
    ContactPack& pack = a.contact_packs[index];
    if (pack.rigid != rigid || (pack.active >> lane & 1U) == 0) return;
    if constexpr (!rigid) {
        contact_of_pack<Frame::triangles, false, uneven>(a, step, pack, index, lane);
    } else if (pack.first_normal >= 0) {
        contact_of_pack<Frame::rigid_own_normal, true, uneven>(a, step, pack, index, lane);
    } else if (pack.central) {
        contact_of_pack<Frame::rigid, true, uneven>(a, step, pack, index, lane);
    } else {
        contact_of_pack<Frame::rigid, false, uneven>(a, step, pack, index, lane);
    }
}

FELDSPAR_HD void loose_contact_thread(const DeviceArrays& a, const KernelStep& step, int thread) {
    if (thread >= a.loose_contacts.count) return;
    const LooseContact& loose = a.loose_contacts[thread];
    SlotForces slot_a, slot_b;
    const auto broke = [&](int p, const BondLawOf<double>& law, BondEvent event, BondState& bond) {
        const ContactPoint& point = a.model.points[p];
        if (point.free_gap_m > 0.0) free_gap(law, point.area_m2, point.free_gap_m, bond);
        note_broken_point(a, step, point.state, event, bond.fracture_J);
    };
    if (loose.contact.plate) {
        if (loose.contact.flexible)
            forces_of_contact<TriangleAttachment, PlateAttachment>(a.model, loose.contact, slot_a, slot_b, step.dt,
                                                                   step.unlimited, broke);
        else
            forces_of_contact<RigidAttachment, PlateAttachment>(a.model, loose.contact, slot_a, slot_b, step.dt, step.unlimited,
                                                                broke);
    } else {
        if (loose.contact.flexible)
            forces_of_contact<TriangleAttachment, TriangleAttachment>(a.model, loose.contact, slot_a, slot_b, step.dt,
                                                                      step.unlimited, broke);
        else
            forces_of_contact<RigidAttachment, RigidAttachment>(a.model, loose.contact, slot_a, slot_b, step.dt, step.unlimited,
                                                                broke);
    }
    a.slots[2 * loose.number] = slot_a;
    a.slots[2 * loose.number + 1] = slot_b;
    if (!loose.contact.flexible) {
        a.rigid_forces[loose.number] = {-slot_a.force, turning_moment(slot_a), turning_moment(slot_b)};
        return;
    }
    if (loose.line_a >= 0) a.lines[loose.line_a].forces = slot_a;
    if (loose.line_b >= 0) a.lines[loose.line_b].forces = slot_b;
}

// ---------------------------------------------------------------------------------------------------------------- grains

// What a thread of the grains' stage has in hand.
struct EdgeWork {
    NodeLanes corner, ring, centre;  // the centre: of the thread of edge 0
    Real2 to_ring;                   // what the ring node of another thread feels
    Real work;
    EdgeThread at;
};

struct GrainBlock {
    double* shared;  // quantity by quantity
    int threads;

    FELDSPAR_INLINE void put(int quantity, int thread, Real2 v) const {
        shared[quantity * threads + thread] = v.x.v;
        shared[(quantity + 1) * threads + thread] = v.y.v;
    }
    FELDSPAR_INLINE Real2 get(int quantity, int thread) const {
        return {shared[quantity * threads + thread], shared[(quantity + 1) * threads + thread]};
    }
};

// Threads of the same grain.
struct Fellows {
    int first, lanes, vertices, ring_nodes, edge, lane;

    FELDSPAR_INLINE Fellows(const GrainPack& pack, const EdgeThread& at)
        : first(at.first),
          lanes(pack.lanes),
          vertices(pack.vertices),
          ring_nodes(pack.vertices - (pack.collapsed ? 1 : 0)),
          edge(at.edge),
          lane(at.lane) {}
    FELDSPAR_INLINE int thread(int k) const { return first + k * lanes + lane; }
    FELDSPAR_INLINE int next() const { return edge + 1 < vertices ? edge + 1 : 0; }
    FELDSPAR_INLINE int before() const { return edge > 0 ? edge - 1 : vertices - 1; }
    FELDSPAR_INLINE int ring_of(int k) const {
        return k < ring_nodes ? k : 0;
    }  // edge whose thread has the ring node behind edge k
    FELDSPAR_INLINE bool has_ring() const { return edge < ring_nodes; }
};

FELDSPAR_INLINE int node_of(const GrainPack& pack, int local, int lane) { return pack.first_node + local * pack.lanes + lane; }

// Phase 0: gravity and pressures on grains that are pressed.
FELDSPAR_HD void press_grain(const DeviceArrays& a, const KernelStep& step, EdgeWork& w) {
    if (w.at.pack < 0 || w.at.edge != 0 || a.pack_forces[w.at.pack] != PackForces::on_top_of_others) return;
    const int number = a.grain_packs[w.at.pack].grain[w.at.lane];
    const Body& grain = a.model.bodies[number];
    for (const int n : grain.nodes()) a.model.nodes.force[n] = a.model.weight.empty() ? Vec2{} : a.model.weight[n];
    add_pressure_of(a.model, grain, a.body_work[number], step.dt);
}

FELDSPAR_INLINE void load_node(const DeviceArrays& a, const double* from_outside, int node, NodeLanes& n) {
    n.X = load_points(a.reference + 2 * node);
    n.u = load_points(a.displacement + 2 * node);
    n.f = from_outside != nullptr ? load_points(from_outside + 2 * node) : Real2{};
}

// Phase 1: the own nodes.
FELDSPAR_INLINE void load_edge(const DeviceArrays& a, const GrainBlock& block, int thread, EdgeWork& w) {
    if (w.at.pack < 0) return;
    const GrainPack& pack = a.grain_packs[w.at.pack];
    const Fellows fellows(pack, w.at);
    const GrainNodes nodes(pack);
    const double* from_outside = a.pack_forces[w.at.pack] == PackForces::on_top_of_others ? a.force : a.weight;
    load_node(a, from_outside, node_of(pack, fellows.edge, fellows.lane), w.corner);
    block.put(0, thread, w.corner.X);
    block.put(2, thread, w.corner.u);
    if (fellows.has_ring()) {
        load_node(a, from_outside, node_of(pack, nodes.ring(fellows.edge), fellows.lane), w.ring);
        block.put(4, thread, w.ring.X);
        block.put(6, thread, w.ring.u);
    }
    load_node(a, fellows.edge == 0 ? from_outside : nullptr, node_of(pack, nodes.centre(), fellows.lane), w.centre);
}

// Where a contact that shares its edge with others has left its forces.
FELDSPAR_HD void sum_shared_edge(const DeviceArrays& a, int line) {
    int low = 0, high = a.shared_edges.count;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (a.shared_edges[middle].line < line)
            low = middle + 1;
        else
            high = middle;
    }
    const SharedEdge& edge = a.shared_edges[low];
    SlotForces sum;
    for (int i = edge.begin; i < edge.end; ++i) sum.add(a.slots[a.shared_slots[i]]);
    a.lines[line].forces = sum;
}

// Phase 2: contacts and triangles. What others feel goes to them in phase 3: to the next corner, to the next ring node, to the
// centre.
FELDSPAR_INLINE void force_edge(const DeviceArrays& a, const GrainBlock& block, EdgeWork& w, Real2& to_corner, Real2& to_centre) {
    if (w.at.pack < 0) return;
    const GrainPack& pack = a.grain_packs[w.at.pack];
    const Fellows fellows(pack, w.at);
    const int line = pack.first_edge + fellows.edge * pack.lanes + fellows.lane;
    if (a.shared_edges.count > 0 && a.shared[line] != 0) sum_shared_edge(a, line);

    const Elastic D(a, w.at.pack, Chunk{fellows.lane, 1});
    const int next = fellows.thread(fellows.next()), next_ring = fellows.thread(fellows.ring_of(fellows.next()));
    NodeLanes j, r = w.ring;
    j.X = block.get(0, next);
    j.u = block.get(2, next);
    if (!fellows.has_ring()) {
        const int ring = fellows.thread(0);
        r.X = block.get(4, ring);
        r.u = block.get(6, ring);
        r.f = Real2{};
    }
    Real2 fi = w.corner.f, fj{}, fr = r.f, fs{}, fc{};
    const Real2 xi = w.corner.position(), xj = j.position(), xr = r.position();
    add_contact_forces(doubles(a.lines + line), 1, w.centre.position(), xi, xj, xr, inverse_of(cross(xj - xi, xr - xi)), fi, fj,
                       fr);
    const double* scale = a.scale + pack.first_triangle + 3 * fellows.edge * pack.lanes + fellows.lane;
    add_triangle(w.corner.X, j.X, r.X, w.corner.u, j.u, r.u, load(scale), D, fi, fj, fr);
    if (fellows.has_ring()) {
        const Real2 sX = block.get(4, next_ring), su = block.get(6, next_ring);
        add_triangle(j.X, sX, r.X, j.u, su, r.u, load(scale + pack.lanes), D, fj, fs, fr);
        add_triangle(w.centre.X, r.X, sX, w.centre.u, r.u, su, load(scale + 2 * pack.lanes), D, fc, fr, fs);
        w.ring.f = fr;
        w.to_ring = fs;
    } else {
        w.to_ring = fr;  // the ring node behind the collapsed edge is that behind the next one
    }
    w.corner.f = fi;
    to_corner = fj;
    to_centre = fc;
}

// Phase 3: gives away what others feel.
FELDSPAR_INLINE void give_forces(const GrainBlock& block, int thread, const EdgeWork& w, Real2 to_corner, Real2 to_centre) {
    if (w.at.pack < 0) return;
    block.put(0, thread, to_corner);
    block.put(2, thread, w.to_ring);
    block.put(4, thread, to_centre);
}

// Phase 4: takes what others gave, and moves the own nodes.
template <bool local>
FELDSPAR_INLINE void move_edge(const DeviceArrays& a, const KernelStep& step, const GrainBlock& block, EdgeWork& w) {
    if (w.at.pack < 0) return;
    const GrainPack& pack = a.grain_packs[w.at.pack];
    const Fellows fellows(pack, w.at);
    const GrainNodes nodes(pack);
    w.corner.f = w.corner.f + block.get(0, fellows.thread(fellows.before()));
    if (fellows.has_ring()) {
        w.ring.f = w.ring.f + block.get(2, fellows.thread(fellows.before()));
        if (pack.collapsed && fellows.edge == 0) w.ring.f = w.ring.f + block.get(2, fellows.thread(pack.vertices - 2));
    }
    if (fellows.edge == 0)
        for (int k = 0; k < pack.vertices; ++k) w.centre.f = w.centre.f + block.get(4, fellows.thread(k));

    const int corner = node_of(pack, fellows.edge, fellows.lane), ring = node_of(pack, nodes.ring(fellows.edge), fellows.lane),
              centre = node_of(pack, nodes.centre(), fellows.lane);
    if (a.pack_forces[w.at.pack] != PackForces::own || step.keep_forces) {
        store_points(a.force + 2 * corner, w.corner.f);
        if (fellows.has_ring()) store_points(a.force + 2 * ring, w.ring.f);
        if (fellows.edge == 0) store_points(a.force + 2 * centre, w.centre.f);
    }
    const ViscousDamping damping(step);
    w.work = move_node<local>(a, step, damping, corner, 1, w.corner);
    if (fellows.has_ring()) w.work += move_node<local>(a, step, damping, ring, 1, w.ring);
    if (fellows.edge == 0) w.work += move_node<local>(a, step, damping, centre, 1, w.centre);
    if constexpr (!local) w.work *= 0.5 * damping.half;
}

// Phase 5: shows how the own nodes move now.
FELDSPAR_INLINE void show_edge(const DeviceArrays& a, const GrainBlock& block, int thread, const EdgeWork& w) {
    if (w.at.pack < 0) return;
    const Fellows fellows(a.grain_packs[w.at.pack], w.at);
    block.put(0, thread, w.corner.position());
    block.put(2, thread, w.corner.f);
    if (fellows.has_ring()) {
        block.put(4, thread, w.ring.position());
        block.put(6, thread, w.ring.f);
    }
    if (fellows.edge == 0) {
        block.put(8, thread, w.centre.position());
        block.put(10, thread, w.centre.f);
    }
    block.shared[12 * block.threads + thread] = w.work.v;
}

// Phase 6: the line of the edge; of edge 0 what the whole grain has done.
template <bool after_step>
FELDSPAR_INLINE void end_edge(const DeviceArrays& a, const KernelStep& step, const GrainBlock& block, int thread,
                              const EdgeWork& w) {
    if (w.at.pack < 0) return;
    const GrainPack& pack = a.grain_packs[w.at.pack];
    const Fellows fellows(pack, w.at);
    const int next = fellows.thread(fellows.next()), ring = fellows.thread(fellows.ring_of(fellows.edge)),
              first = fellows.thread(0);
    const int line = pack.first_edge + fellows.edge * pack.lanes + fellows.lane;
    if (!after_step && a.bare[line] != 0) a.lines[line].forces = SlotForces{};  // it may have had a contact
    write_line(doubles(a.lines + line), nullptr, a.bare + line, 1, block.get(8, first), block.get(0, thread), block.get(0, next),
               block.get(4, ring), block.get(2, thread), block.get(2, next), block.get(6, ring));
    if (!after_step || fellows.edge != 0) return;
    double work = 0.0;
    for (int k = 0; k < pack.vertices; ++k) work += block.shared[12 * block.threads + fellows.thread(k)];
    const int number = pack.grain[fellows.lane];
    a.body_work[number].damping += work;
    if (a.pack_forces[w.at.pack] == PackForces::on_top_of_others)
        finish_pressure_work_of(a.model, a.model.bodies[number], a.body_work[number], step.dt);
}

// Before the first step: the motion of the own nodes as it is, in the places of phase 5.
FELDSPAR_INLINE void load_motion_of_edge(const DeviceArrays& a, EdgeWork& w) {
    if (w.at.pack < 0) return;
    const GrainPack& pack = a.grain_packs[w.at.pack];
    const Fellows fellows(pack, w.at);
    const GrainNodes nodes(pack);
    load_node(a, a.velocity, node_of(pack, fellows.edge, fellows.lane), w.corner);
    if (fellows.has_ring()) load_node(a, a.velocity, node_of(pack, nodes.ring(fellows.edge), fellows.lane), w.ring);
    if (fellows.edge == 0) load_node(a, a.velocity, node_of(pack, nodes.centre(), fellows.lane), w.centre);
}

// ---------------------------------------------------------------------------------------------------------- rigid bodies, plates

FELDSPAR_INLINE void write_line_of_rigid(const DeviceArrays& a, int number, const RigidBody& body, const double* u,
                                         const double* v) {
    double* line = doubles(a.lines + a.line_of_first_body + number);
    const double* X = a.reference + 2 * body.first_node;
    const double turning = v[2] * body.inverse_radius;
    store_points(line, {X[0] + u[0], X[1] + u[1]});
    store_points(line + 2, {v[0], v[1]});
    store_points(line + 4, {0.0, -turning});
    store_points(line + 6, {turning, u[2] * body.inverse_radius});
}

template <bool local>
FELDSPAR_INLINE void rigid_thread(const DeviceArrays& a, const KernelStep& step, int thread) {
    if (thread >= a.rigid_count) return;
    const RigidBody& body = a.rigid_bodies[thread];
    double as_a[4] = {}, as_b[4] = {};
    const auto add = [&](double* sum, const RigidForces& f) {
        sum[0] += f.force.x;
        sum[1] += f.force.y;
        sum[2] += f.moment_a;
        sum[3] += f.moment_b;
    };
    const auto at = [&](std::uint32_t bytes) -> const RigidForces& {
        return *reinterpret_cast<const RigidForces*>(reinterpret_cast<const char*>(a.rigid_forces) + bytes);
    };
    for (int i = 0; i < kAtOnce; ++i) add(as_a, at(body.as_a[i]));
    for (int i = 0; i < kAtOnce; ++i) add(as_b, at(body.as_b[i]));
    for (int i = body.more_begin; i < body.more_end; ++i) {
        const int slot = a.more_of_rigid[i];
        add(slot % 2 == 0 ? as_a : as_b, a.rigid_forces[slot / 2]);
    }
    const int node = 2 * body.first_node;
    double F[4] = {as_b[0] - as_a[0], as_b[1] - as_a[1], (as_a[2] + as_b[3]) * body.inverse_radius, 0.0}, v[4], u[4], work[4];
    const double mass[4] = {a.mass[body.first_node], a.mass[body.first_node], a.mass[body.first_node + 1],
                            a.mass[body.first_node + 1]};
    const ViscousDamping damping(step);
    for (int c = 0; c < 4; ++c) {
        if (a.weight != nullptr) F[c] += a.weight[node + c];
        const double V = a.velocity[node + c], inverse_mass = a.inverse_mass[node + c];
        if constexpr (local) {
            const double drag =
                inverse_mass == 0.0 ? 0.0 : local_drag(V, step.speed * a.loading_mode[node + c], F[c], step.alpha);
            v[c] = V + step.dt * inverse_mass * (F[c] - drag);
            work[c] = 0.5 * step.dt * drag * (V + v[c]);
        } else {
            v[c] = inverse_mass == 0.0 ? V : V * damping.kept + damping.pushed * inverse_mass * F[c];
            work[c] = 0.5 * damping.half * (inverse_mass == 0.0 ? 0.0 : mass[c]) * ((V + v[c]) * (V + v[c]));
        }
        u[c] = a.displacement[node + c] + step.dt * v[c];
    }
    for (int c = 0; c < 4; c += 2) {
        store_points(a.velocity + node + c, {v[c], v[c + 1]});
        store_points(a.displacement + node + c, {u[c], u[c + 1]});
        if (step.keep_forces) store_points(a.force + node + c, {F[c], F[c + 1]});
    }
    a.body_work[thread].damping += (work[0] + work[1]) + (work[2] + work[3]);
    write_line_of_rigid(a, thread, body, u, v);
}

FELDSPAR_INLINE void rigid_line_thread(const DeviceArrays& a, int thread) {
    if (thread >= a.rigid_count) return;
    const RigidBody& body = a.rigid_bodies[thread];
    write_line_of_rigid(a, thread, body, a.displacement + 2 * body.first_node, a.velocity + 2 * body.first_node);
}

FELDSPAR_HD void plate_thread(const DeviceArrays& a, const KernelStep& step, int thread) {
    if (thread >= a.plates.count) return;
    const int number = a.plates[thread];
    const Body& plate = a.model.bodies[number];
    BodyWork& work = a.body_work[number];
    gather_at_centre(a.model, plate);
    if (a.model.pressed) add_pressure_of(a.model, plate, work, step.dt);
    if (step.local_damping)
        move_body<true>(a.model, plate, step.dt, step.alpha, step.viscous, step.speed, work);
    else
        move_body<false>(a.model, plate, step.dt, step.alpha, step.viscous, step.speed, work);
    if (a.model.pressed) finish_pressure_work_of(a.model, plate, work, step.dt);
}

// ---------------------------------------------------------------------------------------------------------------- reaction

// Power of the loading in the step behind, of the nodes that fall to a thread.
FELDSPAR_INLINE double reaction_thread(const DeviceArrays& a, int thread) {
    double sum = 0.0;
    for (int i = thread; i < a.loaded_nodes.count; i += kReactionThreads) {
        const LoadedNode& loaded = a.loaded_nodes[i];
        sum += dot(loaded.share, a.model.nodes.force[loaded.node]);
    }
    return sum;
}

FELDSPAR_INLINE void add_work(const DeviceArrays& a, double force) {
    a.block->loading_J -= force * (a.block->step.dt * a.block->step.speed);
}

}  // namespace
}  // namespace feldspar
