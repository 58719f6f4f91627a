// The steps of a device as loops on the processor. Compiled without contraction, for the plain instruction set (CMakeLists.txt),
// so that the bits are those of the card.
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include "feldspar/gpu/backend.hpp"
#include "feldspar/gpu/step_text.hpp"

namespace feldspar {
namespace {

void reaction(const DeviceArrays& a) {
    double sums[kReactionThreads];
    for (int t = 0; t < kReactionThreads; ++t) sums[t] = reaction_thread(a, t);
    for (int half = kReactionThreads / 2; half > 0; half /= 2)
        for (int t = 0; t < half; ++t) sums[t] += sums[t + half];
    add_work(a, sums[0]);
}

// The threads of one block of the grains' stage.
class GrainThreads {
public:
    explicit GrainThreads(int threads)
        : works_(static_cast<std::size_t>(threads)),
          to_corner_(works_.size()),
          to_centre_(works_.size()),
          shared_(kSharedQuantities * works_.size()) {}

    template <bool local>
    void step(const DeviceArrays& a, const KernelStep& step, int number) {
        const GrainBlock block = begin(a, number);
        if (a.model.pressed) each([&](int, EdgeWork& w) { press_grain(a, step, w); });
        each([&](int t, EdgeWork& w) { load_edge(a, block, t, w); });
        each([&](int t, EdgeWork& w) { force_edge(a, block, w, to_corner_[at(t)], to_centre_[at(t)]); });
        each([&](int t, EdgeWork& w) { give_forces(block, t, w, to_corner_[at(t)], to_centre_[at(t)]); });
        each([&](int, EdgeWork& w) { move_edge<local>(a, step, block, w); });
        each([&](int t, EdgeWork& w) { show_edge(a, block, t, w); });
        each([&](int t, EdgeWork& w) { end_edge<true>(a, step, block, t, w); });
    }
    void lines(const DeviceArrays& a, int number) {
        const GrainBlock block = begin(a, number);
        each([&](int, EdgeWork& w) { load_motion_of_edge(a, w); });
        each([&](int t, EdgeWork& w) { show_edge(a, block, t, w); });
        each([&](int t, EdgeWork& w) { end_edge<false>(a, KernelStep{}, block, t, w); });
    }

private:
    static std::size_t at(int thread) { return static_cast<std::size_t>(thread); }
    GrainBlock begin(const DeviceArrays& a, int number) {
        const int threads = static_cast<int>(works_.size());
        for (int t = 0; t < threads; ++t) works_[at(t)].at = a.edge_threads[number * threads + t];
        return {shared_.data(), threads};
    }
    template <class Phase>
    void each(Phase phase) {
        for (std::size_t t = 0; t < works_.size(); ++t) phase(static_cast<int>(t), works_[t]);
    }

    std::vector<EdgeWork> works_;
    std::vector<Real2> to_corner_, to_centre_;
    std::vector<double> shared_;
};

template <bool uneven>
void contacts(const DeviceArrays& a, const KernelStep& step) {
    const int threads = kMostLanes * a.contact_pack_count;
    if (a.has_flexible_contacts)
        for (int t = 0; t < threads; ++t) contact_thread<false, uneven>(a, step, t);
    if (a.has_rigid_contacts)
        for (int t = 0; t < threads; ++t) contact_thread<true, uneven>(a, step, t);
    for (int t = 0; t < a.loose_contacts.count; ++t) loose_contact_thread(a, step, t);
}

template <bool local>
void bodies(const DeviceArrays& a, const KernelStep& step, const LaunchSizes& sizes, GrainThreads& grains) {
    for (int block = 0; block < sizes.grain_blocks; ++block) grains.step<local>(a, step, block);
    for (int t = 0; t < a.rigid_count; ++t) rigid_thread<local>(a, step, t);
    for (int t = 0; t < a.plates.count; ++t) plate_thread(a, step, t);
}

class Emulation final : public Backend {
public:
    void* allocate(std::size_t bytes) override {  // what nobody has written is no number
        return std::memset(::operator new (bytes, std::align_val_t{64}), 0xFF, bytes);
    }
    void free(void* memory) override { ::operator delete (memory, std::align_val_t{64}); }
    void* allocate_beside(std::size_t bytes) override { return allocate(bytes); }
    void free_beside(void* memory) override { free(memory); }
    void upload(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
    void download(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
    void finish() override {}

    void write_lines(const DeviceArrays& a, const LaunchSizes& sizes) override {
        GrainThreads grains(sizes.grain_threads);
        for (int block = 0; block < sizes.grain_blocks; ++block) grains.lines(a, block);
        for (int t = 0; t < a.rigid_count; ++t) rigid_line_thread(a, t);
    }
    void run(const DeviceArrays& a, const LaunchSizes& sizes, bool local_damping, int count) override {
        GrainThreads grains(sizes.grain_threads);
        for (int k = 0; k < count; ++k) {
            const KernelStep step = step_number(a, k);
            sizes.uneven ? contacts<true>(a, step) : contacts<false>(a, step);
            local_damping ? bodies<true>(a, step, sizes, grains) : bodies<false>(a, step, sizes, grains);
            reaction(a);
        }
    }
};

}  // namespace

std::unique_ptr<Backend> emulated_backend() { return std::make_unique<Emulation>(); }

}  // namespace feldspar
