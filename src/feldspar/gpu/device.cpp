#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/gpu/backend.hpp"
#include "feldspar/step/advance_packs.hpp"

namespace feldspar {

std::string not_ported(const Assembly& assembly) {
    const auto finely = std::count_if(assembly.packs.loose_bodies.begin(), assembly.packs.loose_bodies.end(),
                                      [&](int b) { return assembly.bodies[b].kind == BodyKind::flexible; });
    if (finely > 0)
        return fmt::format(
            "{} grains are meshed more finely than by the ring of each, or have more than {} corners, which the card's steps do "
            "not know",
            finely, kMostVertices);
    return {};
}

double card_bytes(const Assembly& a) {
    const auto bytes = [](const auto& array) { return static_cast<double>(array.size() * sizeof(array[0])); };
    double sum = 6.0 * bytes(a.nodes.velocity) + bytes(a.nodes.mass) + 9.0 * bytes(a.bonds.un_m) + bytes(a.body_work) +
                 bytes(a.slots) + bytes(a.bodies) + bytes(a.slots_of_bodies);
    const Packs& p = a.packs;
    sum += bytes(p.grains) + bytes(p.scale) + 2.0 * bytes(p.volumetric) + bytes(p.lines) + bytes(p.inverse_cross) +
           bytes(p.contacts) + 3.0 * bytes(p.offset) + 2.0 * bytes(p.normal_x) + 2.0 * bytes(p.line_a) + 2.0 * bytes(p.along) +
           bytes(p.rigid_forces) + bytes(p.rigid) + sizeof(EdgeThread) * static_cast<double>(p.inverse_cross.size()) +
           sizeof(BrokenPoint) * static_cast<double>(a.points.size());
    return 1.1 * sum;
}

namespace {

// An array of the device and what it was when it was last equal to the processor's.
struct Mirrored {
    void* device = nullptr;
    char* beside = nullptr;
    std::size_t bytes = 0, room = 0;
};

constexpr std::size_t kPiece = 1 << 16;  // bytes that are compared, and go up, together
constexpr int kMostStepsAtOnce = 50;

class Device final : public StepDevice {
public:
    explicit Device(std::unique_ptr<Backend> backend) : backend_(std::move(backend)) {}
    ~Device() override {
        for (Mirrored& m : mirrored_) {
            backend_->free(m.device);
            backend_->free_beside(m.beside);
        }
    }

    void advance(Assembly& assembly, Team&, const StepSettings& settings, long long first_step, int count,
                 PlatenWork& work) override {
        if (count <= 0) return;
        sort_out_packs(assembly);
        if (const std::string unknown = not_ported(assembly); !unknown.empty())
            throw InputError({.key = "--device"}, unknown, "cpu, or auto", "run this test on the processor");
        next_ = 0;
        DeviceArrays& arrays = bring(assembly);
        BlockOfSteps block;
        block.step = kernel_step(settings);
        block.loading_J = work.loading;
        block.last = count - 1;
        arrays.block = put(&block, 1);
        Mirrored* const of_block = &mirrored_[next_ - 1];
        backend_->write_lines(arrays, sizes_);
        for (int done = 0; done < count; done += kMostStepsAtOnce) {
            if (done > 0) {  // the block's work stays where it is
                block.first = done;
                backend_->upload(&arrays.block->first, &block.first, sizeof block.first);
                backend_->finish();
            }
            backend_->run(arrays, sizes_, block.step.local_damping, std::min(kMostStepsAtOnce, count - done));
        }
        fetch(assembly, arrays);
        take(of_block, &block, 1);
        arrive();
        if (broken_count_[1] != 0 || !arrays.loose_contacts.empty()) {
            fetch_damage(assembly);
            arrive();
        }
        work.loading = block.loading_J;
        if (broken_count_[0] > 0) note_broken(assembly, arrays, first_step);
    }

private:
    // An array on the device, as large as this one; equal to it if it was.
    template <class T>
    T* put(const T* from, std::size_t count) {
        Mirrored& m = room_for(sizeof(T) * count);
        const char* now = reinterpret_cast<const char*>(from);
        const bool known = m.bytes == sizeof(T) * count;
        m.bytes = sizeof(T) * count;
        for (std::size_t at = 0; at < m.bytes;) {  // changed pieces that follow each other go together
            std::size_t end = at;
            while (end < m.bytes) {
                const std::size_t piece = std::min(kPiece, m.bytes - end);
                if (known && std::memcmp(m.beside + end, now + end, piece) == 0) break;
                std::memcpy(m.beside + end, now + end, piece);
                end += piece;
            }
            if (end > at) changed_ = true;
            if (end > at) backend_->upload(static_cast<char*>(m.device) + at, m.beside + at, end - at);
            at = end + kPiece;
        }
        return static_cast<T*>(m.device);
    }
    template <class A>
    auto* put(const A& array) {
        using T = std::remove_cvref_t<decltype(array[0])>;
        return put<T>(array.data(), array.size());
    }
    template <class A>
    double* put_pairs(const A& array) {
        return reinterpret_cast<double*>(put(array));
    }
    template <class A>
    double* put_fixed_pairs(const A& array) {
        return reinterpret_cast<double*>(put_fixed(array));
    }
    template <class A>
    auto list(const A& array) {
        using T = std::remove_cvref_t<decltype(array[0])>;
        return DeviceList<const T>{put(array), static_cast<std::int32_t>(array.size())};
    }

    // The same of what follows from the contacts and the packs: it is not looked at while these stay (see bring()).
    template <class T>
    T* put_fixed(const T* from, std::size_t count) {
        if (!fixed_ || next_ >= mirrored_.size() || mirrored_[next_].bytes != sizeof(T) * count) return put(from, count);
        return static_cast<T*>(mirrored_[next_++].device);
    }
    template <class A>
    auto* put_fixed(const A& array) {
        using T = std::remove_cvref_t<decltype(array[0])>;
        return put_fixed<T>(array.data(), array.size());
    }
    template <class A>
    auto list_fixed(const A& array) {
        using T = std::remove_cvref_t<decltype(array[0])>;
        return DeviceList<const T>{put_fixed(array), static_cast<std::int32_t>(array.size())};
    }

    // Room on the device that the processor does not know. What it holds stays from one block to the next.
    template <class T>
    T* room(std::size_t count) {
        return static_cast<T*>(room_for(sizeof(T) * count).device);
    }

    Mirrored& room_for(std::size_t bytes) {
        if (next_ == mirrored_.size()) mirrored_.emplace_back();
        Mirrored& m = mirrored_[next_++];
        if (bytes > m.room) {
            backend_->free(m.device);
            backend_->free_beside(m.beside);
            m = {};
            const std::size_t more = bytes + bytes / 8 + 256;
            m.device = backend_->allocate(more);
            m.beside = static_cast<char*>(backend_->allocate_beside(more));
            m.room = more;
        }
        return m;
    }

    // What of the device's array the steps have changed, to the processor's: when all has arrived.
    template <class T>
    void take(Mirrored* m, T* to, std::size_t count) {
        if (count == 0) return;
        backend_->download(m->beside, m->device, sizeof(T) * count);
        arriving_.push_back({reinterpret_cast<char*>(to), m->beside, sizeof(T) * count});
    }

    // Waits for what was taken.
    void arrive() {
        backend_->finish();
        for (const auto& [to, from, bytes] : arriving_) std::memcpy(to, from, bytes);
        arriving_.clear();
    }

    void fetch_damage(Assembly& s);
    DeviceArrays& bring(Assembly& s);
    void fetch(Assembly& s, const DeviceArrays& arrays);
    void note_broken(Assembly& s, const DeviceArrays& arrays, long long first_step);
    void seat_grains(const Packs& packs);

    struct Arriving {
        char* to;
        const char* from;
        std::size_t bytes;
    };

    std::unique_ptr<Backend> backend_;
    std::vector<Mirrored> mirrored_;  // in the order in which bring() asks for them
    std::size_t next_ = 0;
    std::vector<Arriving> arriving_;
    bool changed_ = false;  // something went up since this was false
    bool fixed_ = false;    // contacts and packs are those of the block before
    alignas(DeviceArrays) std::byte arrays_[sizeof(DeviceArrays)]{};
    LaunchSizes sizes_;
    std::vector<EdgeThread> seats_;
    std::vector<LooseContact> loose_;
    std::vector<ContactPoint> loose_points_;
    std::vector<InitialShape> loose_shapes_;
    std::vector<DeviceLoad> loads_;
    std::vector<LoadedNode> loaded_;
    std::vector<SharedEdge> shared_;
    std::vector<std::int32_t> plates_;
    std::vector<double> free_gaps_;
    std::array<std::uint32_t, 2> broken_count_{};  // and whether any point is damaged
    struct SizesBefore {
        std::size_t contacts = 0, points = 0, bodies = 0, shared = 0;
        friend bool operator==(const SizesBefore&, const SizesBefore&) = default;
    } sizes_before_;
    RigidForces no_force_;
    struct Places {  // in mirrored_, of what comes back
        std::size_t displacement = 0, velocity = 0, force = 0, bonds = 0, work = 0, slots = 0, broken = 0, broken_count = 0,
                    slip = 0;
    } at_;
};

// All edges of a pack in one block, the packs in their order.
void Device::seat_grains(const Packs& packs) {
    int most = 0;
    for (const GrainPack& pack : packs.grains) most = std::max(most, pack.vertices * pack.lanes);
    sizes_.grain_threads = most <= 128 ? 128 : 256;
    seats_.clear();
    for (std::size_t p = 0; p < packs.grains.size(); ++p) {
        const GrainPack& pack = packs.grains[p];
        const std::size_t threads = static_cast<std::size_t>(sizes_.grain_threads), taken = seats_.size() % threads;
        if (taken + static_cast<std::size_t>(pack.vertices * pack.lanes) > threads)
            seats_.resize(seats_.size() + threads - taken);
        const auto first = static_cast<std::uint16_t>(seats_.size() % threads);
        for (int k = 0; k < pack.vertices; ++k)
            for (int lane = 0; lane < pack.lanes; ++lane)
                seats_.push_back(
                    {static_cast<std::int32_t>(p), first, static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(lane)});
    }
    const std::size_t threads = static_cast<std::size_t>(sizes_.grain_threads);
    seats_.resize((seats_.size() + threads - 1) / threads * threads);
    sizes_.grain_blocks = static_cast<int>(seats_.size() / threads);
}

// Where the arrays stand on the device. They are made in the same place for every block, so that what lies between them stays as
// it is: whether they are the same is asked of all bytes.
DeviceArrays& Device::bring(Assembly& s) {
    Packs& packs = s.packs;
    DeviceArrays& a = *new (arrays_) DeviceArrays(s);
    a.assembly = nullptr;
    a.broke = nullptr;
    if (seats_.empty()) seat_grains(packs);  // grains stay what they are
    sizes_.uneven = !s.own_laws.empty();
    sizes_.other_threads = s.contacts.size() < 16'000 ? 32 : 128;

    // Contacts come and go along the course of a test, and go back with it to a state that it came through; in between what joins
    // which edges tells whether they are the same.
    const bool same_sizes =
        sizes_before_ == SizesBefore{s.contacts.size(), s.points.size(), s.bodies.size(), packs.shared_edges.size()};
    sizes_before_ = {s.contacts.size(), s.points.size(), s.bodies.size(), packs.shared_edges.size()};
    changed_ = fixed_ = false;
    a.line_a = put(packs.line_a);
    a.line_b = put(packs.line_b);
    a.shared = put(packs.shared);
    a.bare = put(packs.bare);
    a.along = put(packs.along);
    fixed_ = same_sizes && !changed_;

    changed_ = false;
    at_.bonds = next_;
    a.un = put(s.bonds.un_m);
    a.us = put(s.bonds.us_m);
    a.damage = put(s.bonds.damage);
    a.fracture = put(s.bonds.fracture_J);
    a.friction = put(s.bonds.friction_J);
    const bool fixed = fixed_;
    fixed_ = fixed && !changed_;  // a state in which no point has moved or been damaged is the same state
    a.Fn = put_fixed(s.bonds.Fn_N);
    a.Fs = put_fixed(s.bonds.Fs_N);
    a.max_un = put_fixed(s.bonds.max_un_m);
    a.max_us = put_fixed(s.bonds.max_us_m);
    fixed_ = fixed;

    a.displacement = put_pairs(s.nodes.displacement);
    at_.displacement = next_ - 1;
    a.velocity = put_pairs(s.nodes.velocity);
    at_.velocity = next_ - 1;
    a.force = reinterpret_cast<double*>(room<Vec2>(s.nodes.force.size()));  // of the last step alone, or made anew in each
    at_.force = next_ - 1;
    a.reference = put_fixed_pairs(s.nodes.reference);
    a.inverse_mass = put_pairs(s.nodes.inverse_mass);
    a.loading_mode = put_pairs(s.nodes.loading_mode);
    a.mass = put(s.nodes.mass);
    const double* weight = put_pairs(s.weight);
    a.weight = s.weight.empty() ? nullptr : weight;
    a.body_work = put(s.body_work);
    at_.work = next_ - 1;
    const bool slots_used =
        !packs.loose_contacts.empty() || !packs.shared_edges.empty();  // and all that are read are written in the same step
    a.slots = room<SlotForces>(slots_used ? s.slots.size() : 0);
    at_.slots = next_ - 1;

    a.grain_packs = put_fixed(packs.grains);
    a.pack_forces = put(packs.forces);
    a.contact_packs = put(packs.contacts);
    a.laws = put(s.laws);
    const auto& own = s.own_laws.constants;
    a.own = {put_fixed(own.Kn_Pa_m),     put_fixed(own.Ks_Pa_m),    put_fixed(own.x0_normal), put_fixed(own.x0_shear),
             put_fixed(own.x_fl_normal), put_fixed(own.x_fl_shear), put_fixed(own.mu)};
    const double *volumetric = put_fixed(packs.volumetric), *deviatoric = put_fixed(packs.deviatoric);
    a.volumetric = packs.volumetric.empty() ? nullptr : volumetric;
    a.deviatoric = packs.deviatoric.empty() ? nullptr : deviatoric;
    a.offset = put_fixed(packs.offset);
    a.tangent_x = put_fixed(packs.tangent_x);
    a.tangent_y = put_fixed(packs.tangent_y);
    a.normal_x = put_fixed(packs.normal_x);
    a.normal_y = put_fixed(packs.normal_y);
    a.area = put_fixed(packs.area);
    a.scale = put_fixed(packs.scale);
    a.lines = room<SideLine>(packs.lines.size());
    a.inverse_cross = nullptr;  // not kept
    a.rigid_bodies = put_fixed(packs.rigid);
    a.more_of_rigid = put_fixed(packs.more_of_rigid);
    a.rigid_forces = room<RigidForces>(packs.rigid_forces.size());
    if (!packs.rigid_forces.empty())
        backend_->upload(a.rigid_forces + packs.rigid_forces.size() - 1, &no_force_, sizeof no_force_);  // of no contact
    a.rigid_count = packs.rigid_end;
    a.edge_threads = list_fixed(seats_);
    shared_ = packs.shared_edges;
    std::sort(shared_.begin(), shared_.end(), [](const SharedEdge& l, const SharedEdge& r) { return l.line < r.line; });
    a.shared_edges = list(shared_);
    a.shared_slots = put(packs.shared_slots);
    a.has_flexible_contacts =
        std::any_of(packs.contacts.begin(), packs.contacts.end(), [](const ContactPack& pack) { return !pack.rigid; });
    a.has_rigid_contacts =
        std::any_of(packs.contacts.begin(), packs.contacts.end(), [](const ContactPack& pack) { return pack.rigid; });

    if (packs.rigid_end > 0 && !fixed_) {
        free_gaps_.assign(s.bonds.un_m.size(), 0.0);
        for (const ContactPoint& point : s.points) free_gaps_[static_cast<std::size_t>(point.state)] = point.free_gap_m;
    }
    const double* free_gap = put_fixed(free_gaps_);
    a.free_gap = free_gaps_.empty() ? nullptr : free_gap;
    broken_count_ = {};
    a.broken = room<BrokenPoint>(s.points.size());
    at_.broken = next_ - 1;
    Mirrored& count = room_for(sizeof broken_count_);
    at_.broken_count = next_ - 1;
    std::memcpy(count.beside, broken_count_.data(), sizeof broken_count_);
    backend_->upload(count.device, count.beside, sizeof broken_count_);
    a.broken_count = static_cast<std::uint32_t*>(count.device);

    loose_.clear();
    loose_points_.clear();
    loose_shapes_.clear();
    for (const int c : packs.loose_contacts) {
        LooseContact loose;
        loose.contact = s.contacts[c];
        loose.number = c;
        for (int p = loose.contact.first_point; p < loose.contact.first_point + loose.contact.points; ++p) {
            loose_points_.push_back(s.points[p]);
            loose_shapes_.push_back(s.initial_shapes.empty() ? InitialShape{} : s.initial_shapes[p]);
        }
        loose.contact.first_point = static_cast<std::int32_t>(loose_points_.size()) - loose.contact.points;
        if (loose.contact.flexible) {
            if (packs.only_contact_on(loose.contact.a.edge)) loose.line_a = packs.line_of_edge[loose.contact.a.edge];
            if (!loose.contact.plate && packs.only_contact_on(loose.contact.b.edge))
                loose.line_b = packs.line_of_edge[loose.contact.b.edge];
        }
        loose_.push_back(loose);
    }
    a.loose_contacts = list(loose_);
    plates_.assign(packs.loose_bodies.begin(), packs.loose_bodies.end());
    a.plates = list(plates_);
    loaded_.clear();
    for (const Fixture& fixture : s.fixtures)
        if (fixture.moves())
            for (const int node : fixture.nodes)
                loaded_.push_back({node, 0, {fixture.imposed.x * fixture.motion.x, fixture.imposed.y * fixture.motion.y}});
    a.loaded_nodes = list(loaded_);
    loads_.clear();
    for (const DeadLoad& load : s.dead_loads)
        loads_.push_back({load.pressure_Pa, load.stiffness_Pa_m, load.rest_m, load.outward, load.plate_node, load.springs});

    DeviceModel& m = a.model;
    m.thickness_m = s.thickness_m;
    m.pressed = s.is_pressed();
    m.laws = a.laws;
    m.own_form = a.own_form;
    m.own = a.own;
    const auto points = [](double* pairs) { return reinterpret_cast<Vec2*>(pairs); };
    const auto points_to_read = [](const double* pairs) { return reinterpret_cast<const Vec2*>(pairs); };
    m.nodes = {points_to_read(a.reference),
               points(a.displacement),
               points(a.velocity),
               points(a.force),
               points_to_read(a.inverse_mass),
               points_to_read(a.loading_mode),
               a.mass};
    m.points = list(loose_points_);
    m.initial_shapes = list(loose_shapes_);
    m.slots = {a.slots, static_cast<std::int32_t>(s.slots.size())};
    m.dead_loads = list(loads_);
    m.dilations = list(s.dilations);
    m.slip = put(s.bonds.slip_m);
    at_.slip = next_ - 1;
    m.weight = {points_to_read(a.weight), static_cast<std::int32_t>(s.weight.size())};
    const bool readable = !loose_.empty() || !plates_.empty() || m.pressed;
    const std::size_t none = 0;
    m.bodies = {put_fixed(s.bodies.data(), readable ? s.bodies.size() : none), static_cast<std::int32_t>(s.bodies.size())};
    m.edges = {put_fixed(s.edges.data(), readable ? s.edges.size() : none), static_cast<std::int32_t>(s.edges.size())};
    m.slots_of_bodies = {put_fixed(s.slots_of_bodies.data(), plates_.empty() ? none : s.slots_of_bodies.size()),
                         static_cast<std::int32_t>(s.slots_of_bodies.size())};
    m.pressure_edges = list_fixed(s.pressure_edges);
    m.un = a.un;
    m.us = a.us;
    m.Fn = a.Fn;
    m.Fs = a.Fs;
    m.max_un = a.max_un;
    m.max_us = a.max_us;
    m.damage = a.damage;
    m.fracture = a.fracture;
    m.friction = a.friction;
    return a;
}

void Device::fetch(Assembly& s, const DeviceArrays& arrays) {
    take(&mirrored_[at_.displacement], s.nodes.displacement.data(), s.nodes.displacement.size());
    take(&mirrored_[at_.velocity], s.nodes.velocity.data(), s.nodes.velocity.size());
    take(&mirrored_[at_.force], s.nodes.force.data(), s.nodes.force.size());
    Bonds& b = s.bonds;
    for (const auto& [place, array] :
         {std::pair{0, &b.un_m}, std::pair{1, &b.us_m}, std::pair{5, &b.Fn_N}, std::pair{6, &b.Fs_N}})
        take(&mirrored_[at_.bonds + static_cast<std::size_t>(place)], array->data(), array->size());
    take(&mirrored_[at_.work], s.body_work.data(), s.body_work.size());
    if (!arrays.loose_contacts.empty() || !arrays.shared_edges.empty())
        take(&mirrored_[at_.slots], s.slots.data(), s.slots.size());
    take(&mirrored_[at_.broken_count], broken_count_.data(), broken_count_.size());
}

// What only damaged points change.
void Device::fetch_damage(Assembly& s) {
    Bonds& b = s.bonds;
    for (const auto& [place, array] : {std::pair{2, &b.damage}, std::pair{3, &b.fracture_J}, std::pair{4, &b.friction_J},
                                       std::pair{7, &b.max_un_m}, std::pair{8, &b.max_us_m}})
        take(&mirrored_[at_.bonds + static_cast<std::size_t>(place)], array->data(), array->size());
    take(&mirrored_[at_.slip], b.slip_m.data(), b.slip_m.size());
}

void Device::note_broken(Assembly& s, const DeviceArrays&, long long first_step) {
    std::vector<BrokenPoint> broken(broken_count_[0]);
    take(&mirrored_[at_.broken], broken.data(), broken.size());
    arrive();
    std::vector<std::int32_t> point_at(s.bonds.un_m.size(), -1);
    for (std::size_t p = 0; p < s.points.size(); ++p)
        point_at[static_cast<std::size_t>(s.points[p].state)] = static_cast<std::int32_t>(p);
    for (const BrokenPoint& b : broken) {  // each point once, so their order is of no concern
        ContactPoint& point = s.points[static_cast<std::size_t>(point_at[static_cast<std::size_t>(b.state)])];
        const auto event = static_cast<BondEvent>(b.step % 4);
        point.broken_step = first_step + b.step / 4;
        point.broke_in_tension = event == BondEvent::broke_in_tension;
        point.lost_compression = event == BondEvent::broke_in_shear_losing_compression;
        point.broken_J = b.fracture_J;
    }
}

}  // namespace

std::unique_ptr<StepDevice> device_over(std::unique_ptr<Backend> backend) { return std::make_unique<Device>(std::move(backend)); }

std::unique_ptr<StepDevice> open_emulation() { return device_over(emulated_backend()); }

namespace {

// For tests of what surrounds a card, on machines without one: results say what has made them.
std::unique_ptr<Backend> backend_here(DeviceProvenance& provenance) {
    const char* memory_MiB = std::getenv("FELDSPAR_EMULATED_CARD");
    if (memory_MiB == nullptr) return cuda_backend(provenance);
    provenance = {"emulation", "an emulated card", "none", "none", "double", std::atof(memory_MiB) * 1048576.0};
    return emulated_backend();
}

}  // namespace

DeviceProvenance card_here() {
    DeviceProvenance provenance;
    (void)backend_here(provenance);
    return provenance;
}

std::unique_ptr<StepDevice> open_card() {
    DeviceProvenance provenance;
    return device_over(backend_here(provenance));
}

}  // namespace feldspar
