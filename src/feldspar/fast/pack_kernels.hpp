// The stages over packs, in vectors of FELDSPAR_LANES doubles. Included once by each kernels_<instruction set>.cpp; with a single
// lane by gpu/, whose threads are lanes: it takes what is done in a lane, and has loops of its own.
//
// The laws are those of laws/, over vectors. What is geometry of contacts and triangles, (C1)-(C19) of docs/theory/contacts.md,
// and motion, step/body_forces.cpp, stands here in the form that costs least; tests/unit/fast compares it with the readable
// stages.
#pragma once

#include "feldspar/fast/kernels.hpp"
#if FELDSPAR_LANES == 1
#include "feldspar/fast/one_lane.hpp"
#else
#include "feldspar/fast/lanes.hpp"
#endif
#include "feldspar/laws/damping.hpp"

namespace feldspar {
namespace {

// Lanes [begin, begin + count) of a pack, as many as a vector has, or fewer in the last one.
struct Chunk {
    int begin;
    int count;
};

// Calls work(chunk) for the vectors of a pack. Where all lanes are taken, `count` is a constant to the compiler.
template <class Work>
FELDSPAR_INLINE void for_each_chunk(int lanes, Work work) {
    int first = 0;
    for (; first + kWidth <= lanes; first += kWidth) work(Chunk{first, kWidth});
    if (first < lanes) work(Chunk{first, lanes - first});
}

FELDSPAR_INLINE Real dot(Real2 a, Real2 b) { return a.x * b.x + a.y * b.y; }
FELDSPAR_INLINE Real cross(Real2 a, Real2 b) { return a.x * b.y - a.y * b.x; }
FELDSPAR_INLINE Real2 operator+(Real2 a, Real2 b) { return {a.x + b.x, a.y + b.y}; }
FELDSPAR_INLINE Real2 operator-(Real2 a, Real2 b) { return {a.x - b.x, a.y - b.y}; }
FELDSPAR_INLINE Real2 operator*(Real a, Real2 b) { return {a * b.x, a * b.y}; }

// ---------------------------------------------------------------------------------------------------------------- contacts

// How one side of each lane moves: centre, velocity and gradient.
struct Side {
    Real2 centre, velocity;
    Real xx, xy, yx, yy;
};

FELDSPAR_INLINE double* doubles(SideLine* line) { return reinterpret_cast<double*>(line); }
FELDSPAR_INLINE double* line_at(SideLine* lines, std::uint32_t bytes) {
    return reinterpret_cast<double*>(reinterpret_cast<char*>(lines) + bytes);
}

FELDSPAR_INLINE void load_motion(double* const (&line)[kWidth], Side& side) {
    const Real4 q = load_quads(line);
    side.centre = {q.q[0], q.q[1]};
    side.velocity = {q.q[2], q.q[3]};
}

// What hangs on both sides of a contact, and which normal its law has.
enum class Frame { triangles, rigid, rigid_own_normal };

// A rigid body's field has the turning speed as its only gradient: L = (0, -w; w, 0). How far it has turned, rad, stands in the
// place of yy.
template <Frame frame>
FELDSPAR_INLINE void load_gradient(double* const (&line)[kWidth], Side& side) {
    if constexpr (frame != Frame::triangles) {
        for (int lane = 0; lane < kWidth; ++lane) side.yx[lane] = line[lane][6];
        if constexpr (frame == Frame::rigid_own_normal)
            for (int lane = 0; lane < kWidth; ++lane) side.yy[lane] = line[lane][7];
    } else {
        double* high[kWidth];
        for (int lane = 0; lane < kWidth; ++lane) high[lane] = line[lane] + 4;
        const Real4 q = load_quads(high);
        side.xx = q.q[0];
        side.xy = q.q[1];
        side.yx = q.q[2];
        side.yy = q.q[3];
    }
}

// A line of forces: F and the moment M = sum of F (x) arm.
FELDSPAR_INLINE void store_forces(double* const (&line)[kWidth], Real2 F, Real xx, Real xy, Real yx, Real yy) {
    double* high[kWidth];
    for (int lane = 0; lane < kWidth; ++lane) high[lane] = line[lane] + 4;
    store_quads(line, {{F.x, F.y, xx, xy}});
    store_quads(high, {{yx, yy, Real{}, Real{}}});
}

using BondLanes = BondStateOf<Real>;

#if FELDSPAR_LANES == 1
FELDSPAR_INLINE void note_broken_point(const KernelArrays& a, const KernelStep& step, int state, BondEvent event,
                                       double fracture_J) {
#if defined(__CUDA_ARCH__)
    const std::uint32_t at = atomicAdd(a.broken_count, 1U);
#else
    const std::uint32_t at = (*a.broken_count)++;
#endif
    a.broken[at] = {state, static_cast<std::int32_t>(4 * step.step + static_cast<int>(event)), fracture_J};
}

// Notes a point that broke in this step; what its free gap changes is changed here (note_break() of model/assembly.hpp).
template <class Law>
FELDSPAR_APART void note_broken(const KernelArrays& a, const KernelStep& step, const Law& law, int state, Real Fn_trial, Real un,
                                Real& Fn, Real& Fs) {
    if (a.free_gap != nullptr && a.free_gap[state] > 0.0) {
        BondState bond{a.un[state],       a.us[state],      Fn.v, Fs.v, a.max_un[state], a.max_us[state], a.damage[state],
                       a.fracture[state], a.friction[state]};
        free_gap(law, a.area[state], a.free_gap[state], bond);
        a.un[state] = bond.un_m;
        a.fracture[state] = bond.fracture_J;
        a.Fn[state] = bond.Fn_N;
        a.Fs[state] = bond.Fs_N;
        Fn = bond.Fn_N;
        Fs = bond.Fs_N;
    }
    note_broken_point(a, step, state, how_it_broke(Fn_trial.v, un.v), a.fracture[state]);
}
#else
// Reports the points that broke in this step and reloads their forces, because the report may change them (free gap).
FELDSPAR_APART void tell_broken(const KernelArrays& a, const KernelStep& step, int first_contact, int point, int state,
                                Mask broke, Real Fn_trial, Real un, int count, Real& Fn, Real& Fs) {
    for (int lane = 0; lane < count; ++lane) {
        if (broke[lane] == 0) continue;
        a.broke(*a.assembly, first_contact + lane, point, how_it_broke(Fn_trial[lane], un[lane]), step.step);
        Fn[lane] = a.Fn[state + lane];
        Fs[lane] = a.Fs[state + lane];
    }
}
#endif

// The points of a pack that is not intact, or not for long; or of which not all lanes take part.
struct PointForces {
    Real Fn, Fs;
};
template <class Law>
FELDSPAR_APART PointForces update_points(const KernelArrays& a, const KernelStep& step, const ContactPack& pack, const Law& law,
                                         Chunk chunk, int j, const Real& dun, const Real& dus) {
    const int state = pack.first_state + j * pack.lanes + chunk.begin, count = chunk.count;
    const Mask takes_part = lanes_of(pack.active >> chunk.begin) & lanes_of((1U << count) - 1U);
    const Real area = load(a.area + state, count), kn = law.Kn_Pa_m * area, ks = law.Ks_Pa_m * area;
    // Another thread may be writing the state of a contact that takes no part here.
    const bool all_take_part = kWidth == 1 || !any(~takes_part);
    const auto of_lanes = [&](const double* p)
                              FELDSPAR_LAMBDA { return all_take_part ? load(p + state) : load_where(p + state, takes_part); };
    BondLanes s{of_lanes(a.un),     of_lanes(a.us),     of_lanes(a.Fn),       of_lanes(a.Fs),      of_lanes(a.max_un),
                of_lanes(a.max_us), of_lanes(a.damage), of_lanes(a.fracture), of_lanes(a.friction)};
    const Mask intact = s.damage == 0.0;
    s.Fn_N = intact ? -kn * s.un_m : s.Fn_N;  // of intact points it is not kept
    s.Fs_N = intact ? -ks * s.us_m : s.Fs_N;
    const Real un = s.un_m + dun, us = s.us_m + dus;
    const Real Fn_elastic = intact ? -kn * un : s.Fn_N - kn * dun, Fs_elastic = intact ? -ks * us : s.Fs_N - ks * dus;
    const Mask linear = step.unlimited ? s.damage < 1.0 : is_linear(law, un, us, s.damage);

    const BondUpdate<Real> update = update_damaged(law, area, dun, dus, s);
    const Mask broke = update.broke & takes_part & ~linear;
    Real Fn = linear ? Fn_elastic : s.Fn_N, Fs = linear ? Fs_elastic : s.Fs_N;
    store_where(a.un + state, un, takes_part, count);
    store_where(a.us + state, us, takes_part, count);
    store_where(a.Fn + state, Fn, takes_part, count);
    store_where(a.Fs + state, Fs, takes_part, count);
    const Mask damaged = takes_part & ~linear;
    store_where(a.max_un + state, s.max_un_m, damaged, count);
    store_where(a.max_us + state, s.max_us_m, damaged, count);
    store_where(a.damage + state, s.damage, damaged, count);
    store_where(a.fracture + state, s.fracture_J, damaged, count);
    store_where(a.friction + state, s.friction_J, damaged, count);
#if FELDSPAR_LANES == 1
    if (any(damaged)) a.broken_count[1] = 1;  // whoever does it
    if (any(broke)) note_broken(a, step, law, state, update.Fn_trial_N, un, Fn, Fs);
#else
    if (any(broke)) tell_broken(a, step, pack.first_contact + chunk.begin, j, state, broke, update.Fn_trial_N, un, count, Fn, Fs);
#endif
    return {Fn, Fs};
}

// The law of a chunk: one for all, or of each lane its own.
template <bool own>
FELDSPAR_INLINE decltype(auto) law_of(const KernelArrays& a, const ContactPack& pack, Chunk chunk) {
    if constexpr (own) {
        const int at = pack.first_law + chunk.begin;
#if FELDSPAR_LANES == 1
        const auto of_lane = [&](const double* constant) { return constant[at]; };
        return bond_law<double>(
            a.own_form, {of_lane(a.own.Kn_Pa_m), of_lane(a.own.Ks_Pa_m), of_lane(a.own.x0_normal), of_lane(a.own.x0_shear),
                         of_lane(a.own.x_fl_normal), of_lane(a.own.x_fl_shear), of_lane(a.own.mu)});
#else
        const auto lanes = [&](const double* constant) FELDSPAR_LAMBDA { return load(constant + at, chunk.count); };
        return bond_law<Real>(a.own_form,
                              {lanes(a.own.Kn_Pa_m), lanes(a.own.Ks_Pa_m), lanes(a.own.x0_normal), lanes(a.own.x0_shear),
                               lanes(a.own.x_fl_normal), lanes(a.own.x_fl_shear), lanes(a.own.mu)});
#endif
    } else {
        return static_cast<const BondLaw&>(a.laws[pack.material]);
    }
}

// A vector turned by an angle: by the series of cosine and sine, to 1e-17 within a quarter; beyond, lane by lane.
FELDSPAR_INLINE Real2 turned(Real2 v, Real angle) {
    Real c{}, s{};
    if (any(absolute(angle) > 0.25)) [[unlikely]] {
        for (int lane = 0; lane < kWidth; ++lane) {
            c[lane] = std::cos(angle[lane]);
            s[lane] = std::sin(angle[lane]);
        }
    } else {
        const Real x = angle * angle;
        c = 1.0 - x * (1.0 / 2.0) *
                      (1.0 - x * (1.0 / 12.0) *
                                 (1.0 - x * (1.0 / 30.0) *
                                            (1.0 - x * (1.0 / 56.0) * (1.0 - x * (1.0 / 90.0) * (1.0 - x * (1.0 / 132.0))))));
        s = angle * (1.0 - x * (1.0 / 6.0) *
                               (1.0 - x * (1.0 / 20.0) *
                                          (1.0 - x * (1.0 / 42.0) * (1.0 - x * (1.0 / 72.0) * (1.0 - x * (1.0 / 110.0))))));
    }
    return {c * v.x - s * v.y, s * v.x + c * v.y};
}

// `central`: one point, at the reference point (of discs), so that nothing along the edge's line matters.
// `own`: its contacts have laws of their own.
template <Frame frame, bool central, bool plain, bool own>
FELDSPAR_INLINE void contacts_of_chunk(const KernelArrays& arrays, const KernelStep& step, ContactPack& pack, int pack_index,
                                       Chunk chunk) {
    constexpr bool rigid = frame != Frame::triangles;
    const KernelArrays a = arrays;  // a copy that nobody else can change: its pointers stay in registers
    const int constants = kMostLanes * pack_index + chunk.begin;
    const auto takes_part = [&](int lane) FELDSPAR_LAMBDA {
        return plain || (lane < chunk.count && (pack.active >> (chunk.begin + lane) & 1U));
    };
    double *line_a[kWidth], *line_b[kWidth];
    for (int lane = 0; lane < kWidth; ++lane) {
        // A lane that takes no part reads what one that does reads: another thread may be writing into its own lines.
        const int of = kWidth == 1 || takes_part(lane) ? constants + lane : kMostLanes * pack_index + lowest_bit(pack.active);
        line_a[lane] = line_at(a.lines, a.line_a[of]);
        line_b[lane] = line_at(a.lines, a.line_b[of]);
    }
    Side A{}, B{};
    load_motion(line_a, A);
    load_motion(line_b, B);
    const Real2 line = B.centre - A.centre;
    const Real square = dot(line, line);
    Real inverse = inverse_root(square);
    begin_now(inverse);  // the gradients are loaded meanwhile, not before
    const Real distance = square * inverse;
    load_gradient<frame>(line_a, A);
    load_gradient<frame>(line_b, B);
    const Real2 m = inverse * line, across_m = {-m.y, m.x};  // the line of centres, on which the reference point lies
    const Real along_m = 0.5 * distance + load(a.offset + constants), from_b = along_m - distance;
    Real2 n = m, s = across_m;  // of the law
    if constexpr (frame == Frame::rigid_own_normal) {
        const int normal = pack.first_normal + chunk.begin;
        n = turned({load(a.normal_x + normal), load(a.normal_y + normal)}, 0.5 * (A.yy + B.yy));
        s = {-n.y, n.x};
    }

    // Relative displacement on the edge's line: that at the reference point, and w times more along the line.
    Real2 v0;
    if constexpr (rigid) {  // L r = w rot90(r)
        v0 = B.velocity - A.velocity + (B.yx * from_b - A.yx * along_m) * across_m;
    } else {
        const Real2 am = {A.xx * m.x + A.xy * m.y, A.yx * m.x + A.yy * m.y},
                    bm = {B.xx * m.x + B.xy * m.y, B.yx * m.x + B.yy * m.y};
        v0 = B.velocity - A.velocity + from_b * bm - along_m * am;
    }
    const Real n0 = step.dt * dot(v0, n), s0 = step.dt * dot(v0, s);
    Real2 t{};
    Real n1{}, s1{};
    if constexpr (!central) {
        t = load(a.tangent_x + constants) * m + load(a.tangent_y + constants) * across_m;
        Real2 v1;
        if constexpr (rigid) {
            const Real turn = B.yx - A.yx;
            v1 = {-turn * t.y, turn * t.x};
        } else {
            const Real xx = B.xx - A.xx, xy = B.xy - A.xy, yx = B.yx - A.yx, yy = B.yy - A.yy;
            v1 = {xx * t.x + xy * t.y, yx * t.x + yy * t.y};
        }
        n1 = step.dt * dot(v1, n);
        s1 = step.dt * dot(v1, s);
    }
    const auto further = [&](Real at_reference, Real more, Real w)
                             FELDSPAR_LAMBDA { return central ? at_reference : at_reference + w * more; };

    Real Fn_sum{}, Fs_sum{}, Fn_moment{}, Fs_moment{};
    const auto add = [&](Real w, Real Fn, Real Fs) FELDSPAR_LAMBDA {
        Fn_sum += Fn;
        Fs_sum += Fs;
        if constexpr (central) return;
        Fn_moment += w * Fn;
        Fs_moment += w * Fs;
    };
    const auto place = [&](int state, int count) FELDSPAR_LAMBDA { return central ? Real{} : load(a.along + state, count); };
    const int points = pack.points, stride = pack.lanes, first = pack.first_state + chunk.begin;
    if (kWidth == 1 || (plain && pack.intact)) {  // a single lane looks for itself, point by point
        const auto constant = [&](const double* of_lanes, double of_all) FELDSPAR_LAMBDA {
            if constexpr (own)
                return load(of_lanes + pack.first_law + chunk.begin);
            else
                return of_all;
        };
        const BondLaw& law = arrays.laws[pack.material];
        auto x0n = constant(a.own.x0_normal, law.normal.x0), x0s = constant(a.own.x0_shear, law.shear.x0);
        if (step.unlimited) x0n = x0s = decltype(x0n){} + __builtin_inf();
        const auto Kn = constant(a.own.Kn_Pa_m, law.Kn_Pa_m), Ks = constant(a.own.Ks_Pa_m, law.Ks_Pa_m);
        for (int j = 0; j < points; ++j) {
            const int state = first + j * stride;
            const Real w = place(state, kWidth), area = load(a.area + state), dun = further(n0, n1, w), dus = further(s0, s1, w);
            const Real un = load(a.un + state) + dun, us = load(a.us + state) + dus;
            Real Fn = -Kn * area * un, Fs = -Ks * area * us;
            auto leaves = (un > x0n) | (absolute(us) > x0s);
            if constexpr (kWidth == 1) {
                if (!pack.intact) leaves = leaves | (load(a.damage + state) != 0.0);
            }
            if (any(leaves)) [[unlikely]] {
                const PointForces damaged =
                    update_points(arrays, step, pack, law_of<own>(arrays, pack, chunk), chunk, j, dun, dus);
                Fn = damaged.Fn;
                Fs = damaged.Fs;
                pack.intact = false;
            } else {
                store(a.un + state, un);
                store(a.us + state, us);
                if (step.keep_forces) {
                    store(a.Fn + state, Fn);
                    store(a.Fs + state, Fs);
                }
            }
            add(w, Fn, Fs);
        }
    } else {
        const auto& law = law_of<own>(arrays, pack, chunk);
        for (int j = 0; j < points; ++j) {
            const Real w = place(first + j * stride, chunk.count);
            const PointForces point = update_points(arrays, step, pack, law, chunk, j, further(n0, n1, w), further(s0, s1, w));
            add(w, point.Fn, point.Fs);
        }
    }

    // On B: force F, and W = sum of w F. Arms: along m to the reference point, then w along t.
    const Real2 F = Fn_sum * n + Fs_sum * s, W = Fn_moment * n + Fs_moment * s;
    const int contact = pack.first_contact + chunk.begin;
    if constexpr (rigid) {
        const Real across = central ? Real{} : cross(t, W),
                   at_reference = frame == Frame::rigid ? Fs_sum : cross(m, F);  // moments: of W, and of F over its arm
        alignas(64) double nowhere[8];
        double* forces[kWidth];
        for (int lane = 0; lane < kWidth; ++lane)
            forces[lane] = takes_part(lane) ? reinterpret_cast<double*>(a.rigid_forces + contact + lane) : nowhere;
        store_quads(forces, {{F.x, F.y, -(along_m * at_reference + across), from_b * at_reference + across}});
    } else {
        const Real Wxx = W.x * t.x, Wxy = W.x * t.y, Wyx = W.y * t.x, Wyy = W.y * t.y;
        const Real2 at_a = along_m * m, at_b = from_b * m;
        const auto apart = [&](const std::uint32_t* lines_of, int lane)
                               FELDSPAR_LAMBDA { return a.shared[lines_of[constants + lane] / sizeof(SideLine)] != 0; };
        alignas(64) double slot_a[plain ? 1 : kWidth][8],
            slot_b[plain ? 1 : kWidth][8];  // of sides that must leave their line alone
        if constexpr (!plain)
            for (int lane = 0; lane < kWidth; ++lane) {
                if (!takes_part(lane) || apart(a.line_a, lane)) line_a[lane] = slot_a[lane];
                if (!takes_part(lane) || apart(a.line_b, lane)) line_b[lane] = slot_b[lane];
            }
        store_forces(line_a, {-F.x, -F.y}, F.x * -at_a.x - Wxx, F.x * -at_a.y - Wxy, F.y * -at_a.x - Wyx, F.y * -at_a.y - Wyy);
        store_forces(line_b, F, F.x * at_b.x + Wxx, F.x * at_b.y + Wxy, F.y * at_b.x + Wyx, F.y * at_b.y + Wyy);
        if constexpr (!plain)
            for (int lane = 0; lane < chunk.count; ++lane) {
                if (!takes_part(lane)) continue;
                const auto slot = [](const double* f) { return SlotForces{{f[0], f[1]}, {f[2], f[3], f[4], f[5]}}; };
                if (apart(a.line_a, lane)) a.slots[2 * (contact + lane)] = slot(slot_a[lane]);
                if (apart(a.line_b, lane)) a.slots[2 * (contact + lane) + 1] = slot(slot_b[lane]);
            }
    }
}

#if FELDSPAR_LANES > 1
template <Frame frame, bool central, bool own>
FELDSPAR_INLINE void chunks_of_pack(const KernelArrays& a, const KernelStep& step, ContactPack& pack, int index) {
    if (pack.plain) {
        for (int first = 0; first < kMostLanes; first += kWidth)
            contacts_of_chunk<frame, central, true, own>(a, step, pack, index, Chunk{first, kWidth});
    } else if (pack.active != 0) {
        for (int first = 0; first < pack.lanes; first += kWidth)
            contacts_of_chunk<frame, central, false, own>(
                a, step, pack, index, Chunk{first, pack.lanes - first < kWidth ? pack.lanes - first : kWidth});
    }
}

template <Frame frame, bool central, bool uneven>
FELDSPAR_INLINE void contacts_of_pack(const KernelArrays& a, const KernelStep& step, ContactPack& pack, int index) {
    if constexpr (uneven) {
        if (pack.first_law >= 0) return chunks_of_pack<frame, central, true>(a, step, pack, index);
    }
    chunks_of_pack<frame, central, false>(a, step, pack, index);
}

// A function for each kind of rock: the code of laws by lane, in one function with the other, would slow that down.
// @tparam uneven  whether there are packs whose contacts have laws of their own
template <bool uneven>
[[gnu::noinline]] void contacts_of_packs(const KernelArrays& a, const KernelStep& step, int begin, int end) {
    SideLine* const lines = a.lines;
    const std::uint32_t *line_a = a.line_a + kMostLanes * (begin + kFetchAhead),
                        *line_b = a.line_b + kMostLanes * (begin + kFetchAhead);
    for (int i = begin; i < end; ++i) {
        ContactPack& pack = a.contact_packs[i];
        for (int lane = 0; lane < kMostLanes; ++lane) {
            __builtin_prefetch(line_at(lines, line_a[lane]));
            __builtin_prefetch(line_at(lines, line_b[lane]));
        }
        line_a += kMostLanes;
        line_b += kMostLanes;
        if (!pack.rigid) {
            contacts_of_pack<Frame::triangles, false, uneven>(a, step, pack, i);
        } else if (pack.first_normal >= 0) {
            contacts_of_pack<Frame::rigid_own_normal, true, uneven>(a, step, pack, i);
        } else if (pack.central) {
            contacts_of_pack<Frame::rigid, true, uneven>(a, step, pack, i);
        } else {
            contacts_of_pack<Frame::rigid, false, uneven>(a, step, pack, i);
        }
    }
}

void contacts(const KernelArrays& a, const KernelStep& step, int begin, int end) {
    if (a.own.Kn_Pa_m != nullptr) {
        contacts_of_packs<true>(a, step, begin, end);
    } else {
        contacts_of_packs<false>(a, step, begin, end);
    }
}
#endif

// ---------------------------------------------------------------------------------------------------------------- grains

constexpr int kMostNodes = 2 * kMostVertices + 1;

// The nodes of a chunk while it is worked on; once a node has moved, its velocity takes the place of its force. (An array for
// each quantity would have stores and loads a multiple of 4 KiB apart wait for each other.)
struct NodeLanes {
    Real2 X, u, f;

    FELDSPAR_INLINE Real2 position() const { return {X.x + u.x, X.y + u.y}; }
};
struct GrainLanes {
    NodeLanes node[kMostNodes];
};

struct Elastic {
    Real volumetric, deviatoric;  // (D11 + D12) t / 2, (D11 - D12) t / 2

    FELDSPAR_INLINE Elastic(const KernelArrays& a, int pack, Chunk chunk) {
        if (a.volumetric == nullptr) {
            volumetric = all(0.5 * a.thickness * (a.D11 + a.D12));
            deviatoric = all(0.5 * a.thickness * (a.D11 - a.D12));
        } else {
            volumetric = load(a.volumetric + kMostLanes * pack + chunk.begin);
            deviatoric = load(a.deviatoric + kMostLanes * pack + chunk.begin);
        }
    }
};

// Undeformed sides of a triangle (i, j, k), and its displacement gradient split as the law has it.
struct TriangleLanes {
    Real2 E1, E2;
    PolarSplit<Real> split;

    FELDSPAR_INLINE TriangleLanes(Real2 Xi, Real2 Xj, Real2 Xk, Real2 ui, Real2 uj, Real2 uk, Real scale)
        : E1(Xj - Xi), E2(Xk - Xi), split(split_of(E1, E2, uj - ui, uk - ui, scale)) {}

private:
    FELDSPAR_INLINE static PolarSplit<Real> split_of(Real2 E1, Real2 E2, Real2 d1, Real2 d2, Real scale) {
        const Real Gxx = d1.x * E2.y - d2.x * E1.y, Gxy = d2.x * E1.x - d1.x * E2.x;  // x 2 A
        const Real Gyx = d1.y * E2.y - d2.y * E1.y, Gyy = d2.y * E1.x - d1.y * E2.x;
        return {scale * (Gxx + Gyy), scale * (Gyx - Gxy), scale * (Gxx - Gyy), scale * (Gxy + Gyx)};
    }
};

// Adds the forces of the triangle (i, j, k): f_j = -V P grad N_j, V grad N_j = t/2 (y_k - y_i, x_i - x_k) undeformed.
FELDSPAR_INLINE void add_triangle(Real2 Xi, Real2 Xj, Real2 Xk, Real2 ui, Real2 uj, Real2 uk, Real scale, const Elastic& D,
                                  Real2& fi, Real2& fj, Real2& fk) {
    const TriangleLanes triangle(Xi, Xj, Xk, ui, uj, uk, scale);
    const Real2 E1 = triangle.E1, E2 = triangle.E2;
    const PlaneStress<Real> P = first_piola_stress(D.volumetric, D.deviatoric, triangle.split);
    const Real2 gj = {P.xy * E2.x - P.xx * E2.y, P.yy * E2.x - P.yx * E2.y},
                gk = {P.xx * E1.y - P.xy * E1.x, P.yx * E1.y - P.yy * E1.x};
    fj = fj + gj;
    fk = fk + gk;
    fi = fi - gj - gk;
}

// The lines of an edge, of consecutive lanes; where there is no lane, nowhere.
FELDSPAR_INLINE void lines_of_edge(double* first, int count, double* nowhere, double* (&line)[kWidth]) {
    for (int lane = 0; lane < kWidth; ++lane) line[lane] = lane < count ? first + 8 * lane : nowhere;
}

// Adds what the contacts of an edge do to the corners (i, j, k) of its triangle: forces_on_corners() of model/attachment.hpp.
FELDSPAR_INLINE void add_contact_forces(double* lines, int count, Real2 centre, Real2 xi, Real2 xj, Real2 xk, Real inverse,
                                        Real2& fi, Real2& fj, Real2& fk) {
    double* line[kWidth];
    lines_of_edge(lines, count, lines, line);
    Side side;  // F in the place of the centre, M behind it
    load_motion(line, side);
    load_gradient<Frame::triangles>(line, side);
    const Real2 F = side.centre, r = centre - xi, e1 = inverse * (xj - xi), e2 = inverse * (xk - xi);
    const Real2 Mx = {side.velocity.x + r.x * F.x, side.xx + r.x * F.y}, My = {side.velocity.y + r.y * F.x, side.xy + r.y * F.y};
    const Real2 gj = e2.y * Mx - e2.x * My, gk = e1.x * My - e1.y * Mx;
    fj = fj + gj;
    fk = fk + gk;
    fi = fi + (F - gj - gk);
}

FELDSPAR_INLINE bool any_set(const std::uint8_t* flags, int count) {
    std::uint64_t bits = 0;
    __builtin_memcpy(&bits, flags, static_cast<std::size_t>(count));
    return bits != 0;
}

// Stores the lines of the lanes that are not bare.
FELDSPAR_APART void store_lines_but(const std::uint8_t* bare, double* lines, int count, const Real4& lower, const Real4& upper) {
    for (int lane = 0; lane < count; ++lane) {
        if (bare[lane]) continue;
        for (int i = 0; i < 4; ++i) {
            lines[8 * lane + i] = lower.q[i][lane];
            lines[8 * lane + 4 + i] = upper.q[i][lane];
        }
    }
}

// Writes how an edge moves: the linear velocity field of its triangle (i, j, k), at the grain's centre. Bare edges stay without
// force.
FELDSPAR_INLINE void write_line(double* lines, double* inverse_cross, const std::uint8_t* bare, int count, Real2 centre, Real2 xi,
                                Real2 xj, Real2 xk, Real2 vi, Real2 vj, Real2 vk) {
    const Real2 e1 = xj - xi, e2 = xk - xi, d1 = vj - vi, d2 = vk - vi, r = centre - xi;
    const Real inverse = inverse_of(cross(e1, e2));
    if constexpr (kWidth > 1)
        store(inverse_cross, inverse, count);  // a single lane computes it anew where it is needed: memory costs a card more
    const Real xx = inverse * (d1.x * e2.y - d2.x * e1.y), xy = inverse * (d2.x * e1.x - d1.x * e2.x);
    const Real yx = inverse * (d1.y * e2.y - d2.y * e1.y), yy = inverse * (d2.y * e1.x - d1.y * e2.x);
    const Real2 v = {vi.x + (xx * r.x + xy * r.y), vi.y + (yx * r.x + yy * r.y)};
    const Real4 lower{{centre.x, centre.y, v.x, v.y}}, upper{{xx, xy, yx, yy}};
    if (any_set(bare, count)) [[unlikely]]
        return store_lines_but(bare, lines, count, lower, upper);
    alignas(64) double nowhere[8];
    double *low[kWidth], *high[kWidth];
    lines_of_edge(lines, count, nowhere, low);
    for (int lane = 0; lane < kWidth; ++lane) high[lane] = low[lane] + 4;
    store_quads(low, lower);
    store_quads(high, upper);
}

struct Moved {
    Real velocity, damping_work;
};

// m dV/dt = F - drag, one component (laws/damping.hpp).
FELDSPAR_INLINE Moved damp_locally(const KernelStep& step, Real V, Real F, Real inverse_mass, Real loading) {
    const Real drag = inverse_mass == 0.0 ? Real{} : local_drag(V, loading, F, step.alpha);
    const Real next = V + step.dt * inverse_mass * (F - drag);
    return {next, 0.5 * step.dt * drag * (V + next)};
}

// V <- (V (1 - h) + dt F/m) / (1 + h), h = c dt / 2.
struct ViscousDamping {
    double kept, pushed;  // (1 - h) / (1 + h), dt / (1 + h)
    double half;          // h

    FELDSPAR_INLINE explicit ViscousDamping(const KernelStep& step)
        : kept((1.0 - 0.5 * step.viscous * step.dt) / (1.0 + 0.5 * step.viscous * step.dt)),
          pushed(step.dt / (1.0 + 0.5 * step.viscous * step.dt)),
          half(0.5 * step.viscous * step.dt) {}
};

// New velocity and displacement of a node from its force; the velocity is left in its place.
// @return work taken out by the damping; viscous: that over h / 2
template <bool local>
FELDSPAR_INLINE Real move_node(const KernelArrays& a, const KernelStep& step, const ViscousDamping& damping, int node, int count,
                               NodeLanes& n) {
    const Real2 F = n.f;
    const Real2 V = load_points(a.velocity + 2 * node, count), inverse_mass = load_points(a.inverse_mass + 2 * node, count);
    Real work;
    if constexpr (local) {
        const Real2 B = load_points(a.loading_mode + 2 * node, count);
        const Moved x = damp_locally(step, V.x, F.x, inverse_mass.x, step.speed * B.x),
                    y = damp_locally(step, V.y, F.y, inverse_mass.y, step.speed * B.y);
        n.f = {x.velocity, y.velocity};
        work = x.damping_work + y.damping_work;
    } else {
        const Real mass = load(a.mass + node, count);
        const auto next = [&](Real v, Real f, Real free)
                              FELDSPAR_LAMBDA { return free == 0.0 ? v : v * damping.kept + damping.pushed * f * free; };
        const auto twice_mean = [&](Real v, Real after, Real free)
                                    FELDSPAR_LAMBDA { return free == 0.0 ? Real{} : (v + after) * (v + after); };
        n.f = {next(V.x, F.x, inverse_mass.x), next(V.y, F.y, inverse_mass.y)};
        work = mass * (twice_mean(V.x, n.f.x, inverse_mass.x) + twice_mean(V.y, n.f.y, inverse_mass.y));
    }
    n.u = {n.u.x + step.dt * n.f.x, n.u.y + step.dt * n.f.y};
    store_points(a.velocity + 2 * node, n.f, count);
    store_points(a.displacement + 2 * node, n.u, count);
    return work;
}

// Local numbers of the nodes: vertices, centre, ring.
struct GrainNodes {
    int vertices, ring_nodes;

    FELDSPAR_INLINE explicit GrainNodes(const GrainPack& pack)
        : vertices(pack.vertices), ring_nodes(pack.vertices - pack.collapsed) {}
    FELDSPAR_INLINE int centre() const { return vertices; }
    FELDSPAR_INLINE int ring(int k) const { return vertices + 1 + (k < ring_nodes ? k : 0); }
    FELDSPAR_INLINE int next(int k) const { return k + 1 < vertices ? k + 1 : 0; }
};

#if FELDSPAR_LANES > 1
FELDSPAR_INLINE void write_lines(const KernelArrays& a, const GrainPack& pack, const GrainLanes& g, Chunk chunk) {
    const GrainNodes nodes(pack);
    const Real2 centre = g.node[nodes.centre()].position();
    Real2 xi = g.node[0].position(), vi = g.node[0].f;
    for (int k = 0; k < pack.vertices; ++k) {
        const NodeLanes &next = g.node[nodes.next(k)], &ring = g.node[nodes.ring(k)];
        const int field = pack.first_edge + k * pack.lanes + chunk.begin;
        const Real2 xj = next.position(), vj = next.f;
        write_line(doubles(a.lines + field), a.inverse_cross + field, a.bare + field, chunk.count, centre, xi, xj,
                   ring.position(), vi, vj, ring.f);
        xi = xj;
        vi = vj;
    }
}

template <bool local>
FELDSPAR_INLINE void grains_of_chunk(const KernelArrays& arrays, const KernelStep& step, int index, Chunk chunk) {
    const KernelArrays a = arrays;  // a copy that nobody else can change: its pointers stay in registers
    const GrainPack& pack = a.grain_packs[index];
    const PackForces forces = a.pack_forces[index];
    GrainLanes g;
    const GrainNodes nodes(pack);
    const int count = pack.nodes(), first = pack.first_node + chunk.begin;
    const double* from_outside =
        forces == PackForces::on_top_of_others ? a.force : a.weight;  // pressures come on top of the weight
    for (int i = 0; i < count; ++i) {
        const int node = first + i * pack.lanes;
        g.node[i].X = load_points(a.reference + 2 * node, chunk.count);
        g.node[i].u = load_points(a.displacement + 2 * node, chunk.count);
        g.node[i].f = from_outside != nullptr ? load_points(from_outside + 2 * node, chunk.count) : Real2{};
    }

    const Elastic D(a, index, chunk);
    NodeLanes& hub = g.node[nodes.centre()];
    const Real2 centre = hub.position();
    Real2 centre_force = hub.f;
    const double* scale = a.scale + pack.first_triangle + chunk.begin;
    for (int k = 0; k < pack.vertices; ++k) {
        const int next = nodes.next(k), edge = pack.first_edge + k * pack.lanes + chunk.begin;
        NodeLanes &i = g.node[k], &j = g.node[next], &r = g.node[nodes.ring(k)];
        Real2 fi = i.f, fj = j.f, fr = r.f;
        add_contact_forces(doubles(a.lines + edge), chunk.count, centre, i.position(), j.position(), r.position(),
                           load(a.inverse_cross + edge, chunk.count), fi, fj, fr);
        add_triangle(i.X, j.X, r.X, i.u, j.u, r.u, load(scale, chunk.count), D, fi, fj, fr);
        scale += pack.lanes;
        if (k + 1 < pack.vertices || !pack.collapsed) {
            NodeLanes& s = g.node[nodes.ring(next)];
            Real2 fs = s.f;
            add_triangle(j.X, s.X, r.X, j.u, s.u, r.u, load(scale, chunk.count), D, fj, fs, fr);
            scale += pack.lanes;
            add_triangle(hub.X, r.X, s.X, hub.u, r.u, s.u, load(scale, chunk.count), D, centre_force, fr, fs);
            scale += pack.lanes;
            s.f = fs;
        }
        i.f = fi;
        j.f = fj;
        r.f = fr;
    }
    hub.f = centre_force;

    if (forces != PackForces::own || step.keep_forces)
        for (int i = 0; i < count; ++i) store_points(a.force + 2 * (first + i * pack.lanes), g.node[i].f, chunk.count);
    Real work{};
    const ViscousDamping damping(step);
    for (int i = 0; i < count; ++i) work += move_node<local>(a, step, damping, first + i * pack.lanes, chunk.count, g.node[i]);
    if constexpr (!local) work *= 0.5 * damping.half;
    for (int lane = 0; lane < chunk.count; ++lane) a.body_work[pack.grain[chunk.begin + lane]].damping += work[lane];
    write_lines(a, pack, g, chunk);
}

void grains(const KernelArrays& a, const KernelStep& step, int begin, int end) {
    for (int i = begin; i < end; ++i) {
        const GrainPack& pack = a.grain_packs[i];
        if (step.local_damping) {
            for_each_chunk(pack.lanes, [&](Chunk chunk) FELDSPAR_LAMBDA { grains_of_chunk<true>(a, step, i, chunk); });
        } else {
            for_each_chunk(pack.lanes, [&](Chunk chunk) FELDSPAR_LAMBDA { grains_of_chunk<false>(a, step, i, chunk); });
        }
    }
}

void grain_lines(const KernelArrays& a, int begin, int end) {
    GrainLanes g;
    for (int p = begin; p < end; ++p) {
        const GrainPack& pack = a.grain_packs[p];
        for_each_chunk(pack.lanes, [&](Chunk chunk) FELDSPAR_LAMBDA {
            for (int i = 0; i < pack.nodes(); ++i) {
                const int node = pack.first_node + chunk.begin + i * pack.lanes;
                g.node[i].X = load_points(a.reference + 2 * node, chunk.count);
                g.node[i].u = load_points(a.displacement + 2 * node, chunk.count);
                g.node[i].f = load_points(a.velocity + 2 * node, chunk.count);
            }
            write_lines(a, pack, g, chunk);
        });
    }
}

// ---------------------------------------------------------------------------------------------------------------- rigid bodies

// Centre and turn of a body as one vector of four: x, y, arc, and nothing.
template <bool local>
FELDSPAR_INLINE Quad move_rigid(const KernelStep& step, const ViscousDamping& damping, Quad V, Quad F, Quad inverse_mass,
                                Quad mass, Quad B, Quad& damping_work) {
    const Quad none{};
    if constexpr (local) {
        const Quad drag = inverse_mass == 0.0 ? none : local_drag(V, step.speed * B, F, step.alpha);
        const Quad next = V + step.dt * inverse_mass * (F - drag);
        damping_work = 0.5 * step.dt * drag * (V + next);
        return next;
    } else {
        const Quad next = inverse_mass == 0.0 ? V : V * damping.kept + damping.pushed * inverse_mass * F;
        const Quad moving = inverse_mass == 0.0 ? none : mass;
        damping_work = 0.5 * damping.half * moving * ((V + next) * (V + next));
        return next;
    }
}

// Of all contacts of a body: Fx, Fy, moment over radius.
FELDSPAR_INLINE Quad forces_on(const KernelArrays& a, const RigidBody& body) {
    const auto of = [&](std::uint32_t bytes) FELDSPAR_LAMBDA {
        return load_quad(reinterpret_cast<const double*>(reinterpret_cast<const char*>(a.rigid_forces) + bytes));
    };
    Quad as_a{}, as_b{};
    for (const std::uint32_t contact : body.as_a) as_a += of(contact);
    for (const std::uint32_t contact : body.as_b) as_b += of(contact);
    for (int i = body.more_begin; i < body.more_end; ++i) {
        const auto slot = static_cast<std::uint32_t>(a.more_of_rigid[i]);
        (slot % 2 == 0 ? as_a : as_b) += of(slot / 2 * static_cast<std::uint32_t>(sizeof(RigidForces)));
    }
    const Quad F = as_b - as_a;
    return Quad{F[0], F[1], (as_a[2] + as_b[3]) * body.inverse_radius, 0.0};
}

FELDSPAR_INLINE void write_rigid_line(const KernelArrays& a, int number, const RigidBody& body, Quad u, Quad v) {
    double* line = doubles(a.lines + a.line_of_first_body + number);
    const double* X = a.reference + 2 * body.first_node;
    const double turning = v[2] * body.inverse_radius;
    store_quad(line, Quad{X[0] + u[0], X[1] + u[1], v[0], v[1]});
    store_quad(line + 4, Quad{0.0, -turning, turning, u[2] * body.inverse_radius});
}

template <bool local>
FELDSPAR_INLINE void rigid_bodies(const KernelArrays& arrays, const KernelStep& settings, int begin, int end) {
    const KernelArrays a = arrays;  // copies that nobody else can change: their members stay in registers
    const KernelStep step = settings;
    const ViscousDamping damping(step);
    for (int i = begin; i < end; ++i) {
        const RigidBody& body = a.rigid_bodies[i];
        const int node = 2 * body.first_node;
        Quad F = forces_on(a, body);
        if (a.weight != nullptr) F += load_quad(a.weight + node);
        const Quad inverse_mass = load_quad(a.inverse_mass + node);
        const double m = a.mass[body.first_node], turn_mass = a.mass[body.first_node + 1];
        Quad work;
        const Quad V = move_rigid<local>(step, damping, load_quad(a.velocity + node), F, inverse_mass,
                                         Quad{m, m, turn_mass, turn_mass}, load_quad(a.loading_mode + node), work);
        const Quad u = load_quad(a.displacement + node) + step.dt * V;
        store_quad(a.velocity + node, V);
        store_quad(a.displacement + node, u);
        if (step.keep_forces) store_quad(a.force + node, F);
        a.body_work[i].damping += (work[0] + work[1]) + (work[2] + work[3]);
        write_rigid_line(a, i, body, u, V);
    }
}

void rigid(const KernelArrays& a, const KernelStep& step, int begin, int end) {
    if (step.local_damping) {
        rigid_bodies<true>(a, step, begin, end);
    } else {
        rigid_bodies<false>(a, step, begin, end);
    }
}

void rigid_lines(const KernelArrays& a, int begin, int end) {
    for (int i = begin; i < end; ++i) {
        const int node = 2 * a.rigid_bodies[i].first_node;
        write_rigid_line(a, i, a.rigid_bodies[i], load_quad(a.displacement + node), load_quad(a.velocity + node));
    }
}

// -------------------------------------------------------------------------------------------------------------- sums of a record

FELDSPAR_INLINE double sum_of(Real v) {
    double sum = 0.0;
    for (int lane = 0; lane < kWidth; ++lane) sum += v[lane];
    return sum;
}

NodeSums node_sums(const KernelArrays& a, const KernelStep& step) {
    Real kinetic{}, deviation{}, ahead{};
    const double half = 0.5 * step.viscous * step.dt, inverse = 1.0 / (1.0 - half);
    const auto add = [&](int at, int count, Real mass) FELDSPAR_LAMBDA {  // components [at, at + count)
        const Real V = load(a.velocity + at, count), F = load(a.force + at, count),
                   inverse_mass = load(a.inverse_mass + at, count);
        const Real loading = step.speed * load(a.loading_mode + at, count), w = V - loading;
        const Real before = step.local_damping ? before_local_drag(V, loading, F, step.dt * inverse_mass, step.alpha)
                                               : (V * (1.0 + half) - step.dt * inverse_mass * F) * inverse;
        const Real m = inverse_mass == 0.0 ? Real{} : mass;
        kinetic += m * V * before;
        deviation += m * w * w;
        ahead += V * (inverse_mass == 0.0 ? Real{} : step.dt * F - m * (V - before));
    };
    const auto part = [](int count) { return count < 0 ? 0 : count < kWidth ? count : kWidth; };
    for (int n = 0; n < a.node_count; n += kWidth) {
        Real lower, upper;
        const int nodes = part(a.node_count - n);
        twice(load(a.mass + n, nodes), lower, upper);
        add(2 * n, part(2 * nodes), lower);
        add(2 * n + kWidth, part(2 * nodes - kWidth), upper);
    }
    return {0.5 * sum_of(kinetic), 0.5 * sum_of(deviation), 0.5 * sum_of(ahead)};
}

void unbalanced(const KernelArrays& a, double* of_bodies) {
    for (int p = 0; p < a.grain_pack_count; ++p) {
        const GrainPack& pack = a.grain_packs[p];
        for_each_chunk(pack.lanes, [&](Chunk chunk) FELDSPAR_LAMBDA {
            Real sum{};
            for (int i = 0; i < pack.nodes(); ++i) {
                const int node = pack.first_node + chunk.begin + i * pack.lanes;
                const Real2 F = load_points(a.force + 2 * node, chunk.count),
                            free = load_points(a.inverse_mass + 2 * node, chunk.count);
                sum += free.x == 0.0 ? Real{} : absolute(F.x);
                sum += free.y == 0.0 ? Real{} : absolute(F.y);
            }
            for (int lane = 0; lane < chunk.count; ++lane) of_bodies[pack.grain[chunk.begin + lane]] = sum[lane];
        });
    }
}

// V W of a triangle.
FELDSPAR_INLINE Real triangle_energy(const NodeLanes& i, const NodeLanes& j, const NodeLanes& k, Real scale, const Elastic& D) {
    const TriangleLanes triangle(i.X, j.X, k.X, i.u, j.u, k.u, scale);
    return cross(triangle.E1, triangle.E2) * strain_energy_density(D.volumetric, D.deviatoric, triangle.split);  // t/2 is in D
}

double energy_of_grains(const KernelArrays& a, double since) {
    Real sum{};
    GrainLanes g;
    for (int p = 0; p < a.grain_pack_count; ++p) {
        const GrainPack& pack = a.grain_packs[p];
        const GrainNodes nodes(pack);
        for_each_chunk(pack.lanes, [&](Chunk chunk) FELDSPAR_LAMBDA {
            const Elastic D(a, p, chunk);
            for (int i = 0; i < pack.nodes(); ++i) {
                const int node = pack.first_node + chunk.begin + i * pack.lanes;
                const Real2 v = load_points(a.velocity + 2 * node, chunk.count);
                g.node[i].X = load_points(a.reference + 2 * node, chunk.count);
                g.node[i].u = load_points(a.displacement + 2 * node, chunk.count) - Real2{since * v.x, since * v.y};
            }
            const double* scale = a.scale + pack.first_triangle + chunk.begin;
            const auto add = [&](int i, int j, int k) FELDSPAR_LAMBDA {  // lanes without a grain have no area
                sum += triangle_energy(g.node[i], g.node[j], g.node[k], load(scale, chunk.count), D);
                scale += pack.lanes;
            };
            for (int k = 0; k < pack.vertices; ++k) {
                const int next = nodes.next(k);
                add(k, next, nodes.ring(k));
                if (k + 1 == pack.vertices && pack.collapsed) continue;
                add(next, nodes.ring(next), nodes.ring(k));
                add(nodes.centre(), nodes.ring(k), nodes.ring(next));
            }
        });
    }
    return sum_of(sum);
}

PackEnergies energies(const KernelArrays& a, double since) {
    PackEnergies sums;
    sums.grains = energy_of_grains(a, since);
    Real fracture{}, friction{};
    for (int p = 0; p < a.contact_pack_count; ++p) {
        const ContactPack& pack = a.contact_packs[p];
        Real stored{};
        const auto add = [&](const auto& law, int state, int count) FELDSPAR_LAMBDA {
            const Real Fn = load(a.Fn + state, count), Fs = load(a.Fs + state, count), area = load(a.area + state, count);
            const Real inverse_area = area > 0.0 ? 1.0 / area : Real{};
            stored += normal_energy(law, inverse_area, Fn, load(a.un + state, count), load(a.damage + state, count)) +
                      0.5 * law.inverse_Ks * inverse_area * Fs * Fs;
            fracture += load(a.fracture + state, count);
            friction += load(a.friction + state, count);
        };
        if (pack.first_law >= 0) {
            for_each_chunk(pack.lanes, [&](Chunk chunk) FELDSPAR_LAMBDA {
                const auto law = law_of<true>(a, pack, chunk);
                for (int j = 0; j < pack.points; ++j) add(law, pack.first_state + j * pack.lanes + chunk.begin, chunk.count);
            });
        } else {
            const int end = pack.first_state + pack.lanes * pack.points;
            for (int state = pack.first_state; state < end; state += kWidth)
                add(a.laws[pack.material], state, end - state < kWidth ? end - state : kWidth);
        }
        sums.contacts[static_cast<std::size_t>(pack.material)] += sum_of(stored);
    }
    sums.fracture = sum_of(fracture);
    sums.friction = sum_of(friction);
    return sums;
}

#endif

}  // namespace
}  // namespace feldspar
