// What the threads of a device see of an assembly: plain pointers and numbers, handed to every kernel by value.
#pragma once

#include <cstdint>

#include "feldspar/base/device_code.hpp"
#include "feldspar/fast/kernels.hpp"

namespace feldspar {

/// A thread of the grains' stage: an edge of a grain, with the corner where it begins and the ring node behind it. All edges of a
/// pack are in one block of threads.
struct EdgeThread {
    std::int32_t pack = -1;   ///< -1: idle
    std::uint16_t first = 0;  ///< thread of the block with which the pack begins
    std::uint8_t edge = 0;
    std::uint8_t lane = 0;
};

/// An array on the device.
template <class T>
struct DeviceList {
    T* data = nullptr;
    std::int32_t count = 0;
    std::int32_t unused = 0;  // no bytes that nobody has written: lists of arrays are compared as they stand

    FELDSPAR_HD T& operator[](int i) const { return data[i]; }
    FELDSPAR_HD bool empty() const { return count == 0; }
};

struct DeviceNodes {
    const Vec2* reference = nullptr;
    Vec2 *displacement = nullptr, *velocity = nullptr, *force = nullptr;
    const Vec2 *inverse_mass = nullptr, *loading_mode = nullptr;
    const double* mass = nullptr;

    FELDSPAR_HD Vec2 position(int node) const { return reference[node] + displacement[node]; }
};

/// A DeadLoad as a step needs it.
struct DeviceLoad {
    double pressure_Pa = 0.0, stiffness_Pa_m = 0.0, rest_m = 0.0;
    Vec2 outward;
    std::int32_t plate_node = -1;
    bool springs = false;
};

/// The members of an Assembly that the readable stages ask for (step/one_contact.hpp, step/one_body.hpp). Contact points are
/// those of loose contacts alone.
struct DeviceModel {
    double thickness_m = 0.0;
    bool pressed = false;
    const BondLaw* laws = nullptr;
    LawForm own_form;
    LawConstants<const double*> own;
    DeviceNodes nodes;
    DeviceList<const Body> bodies;
    DeviceList<const GrainEdge> edges;
    DeviceList<const ContactPoint> points;
    DeviceList<const InitialShape> initial_shapes;
    DeviceList<SlotForces> slots;
    DeviceList<const std::int32_t> slots_of_bodies;
    DeviceList<const PressureEdge> pressure_edges;
    DeviceList<const DeviceLoad> dead_loads;
    DeviceList<const Vec2> weight;
    DeviceList<const Dilation> dilations;
    double *un = nullptr, *us = nullptr, *Fn = nullptr, *Fs = nullptr, *max_un = nullptr, *max_us = nullptr, *damage = nullptr,
           *fracture = nullptr, *friction = nullptr, *slip = nullptr;

    FELDSPAR_HD double& slip_m(int point) const { return slip[points[point].state]; }
    FELDSPAR_HD BondState bond(int point) const {
        const int i = points[point].state;
        return {un[i], us[i], Fn[i], Fs[i], max_un[i], max_us[i], damage[i], fracture[i], friction[i]};
    }
    FELDSPAR_HD void set_bond(int point, const BondState& s) const {
        const int i = points[point].state;
        un[i] = s.un_m;
        us[i] = s.us_m;
        Fn[i] = s.Fn_N;
        Fs[i] = s.Fs_N;
        max_un[i] = s.max_un_m;
        max_us[i] = s.max_us_m;
        damage[i] = s.damage;
        fracture[i] = s.fracture_J;
        friction[i] = s.friction_J;
    }
    FELDSPAR_HD BondLawOf<double> law_of(const Contact& contact) const {
        const int i = contact.own_law;
        if (i < 0) return laws[contact.material];
        return bond_law<double>(own_form, {own.Kn_Pa_m[i], own.Ks_Pa_m[i], own.x0_normal[i], own.x0_shear[i], own.x_fl_normal[i],
                                           own.x_fl_shear[i], own.mu[i]});
    }
    FELDSPAR_HD double rotation(int body) const {
        return nodes.displacement[bodies[body].centre_node + 1].x / bodies[body].radius_m;
    }
    FELDSPAR_HD double pressure_Pa(const DeviceLoad& load, Vec2 back = {}) const {
        return pressure_of(load, load.springs ? nodes.displacement[load.plate_node] - back : Vec2{});
    }
};

/// A contact that goes through the readable stage, and where its forces go.
struct LooseContact {
    Contact contact;                        ///< its first point is one of DeviceModel::points
    std::int32_t number = 0;                ///< into Assembly::contacts
    std::int32_t line_a = -1, line_b = -1;  ///< lines that take its forces; -1: none
};

/// A node whose force is a part of the loading's reaction, and its share.
struct LoadedNode {
    std::int32_t node = 0;
    std::int32_t unused = 0;
    Vec2 share;  ///< motion of its fixture where that is imposed
};

/// What changes from one block of steps to the next.
struct BlockOfSteps {
    KernelStep step;
    double loading_J = 0.0;  ///< work of the loading, so far
    std::int32_t first = 0;  ///< steps of the block that were made in calls before
    std::int32_t last = 0;   ///< of the block: forces are kept
};

struct DeviceArrays : KernelArrays {
    explicit DeviceArrays(Assembly& of) : KernelArrays(of) {}

    DeviceModel model;
    DeviceList<const EdgeThread> edge_threads;  ///< a multiple of the block
    DeviceList<const SharedEdge> shared_edges;  ///< by line
    const std::int32_t* shared_slots = nullptr;
    DeviceList<const LooseContact> loose_contacts;
    DeviceList<const std::int32_t> plates;  ///< bodies
    DeviceList<const LoadedNode> loaded_nodes;
    BlockOfSteps* block = nullptr;
    std::int32_t rigid_count = 0;
    bool has_flexible_contacts = false, has_rigid_contacts = false;
};
static_assert(sizeof(DeviceArrays) <= 4096 - 64, "all parameters of a kernel have room in 4 KiB");

}  // namespace feldspar
