// A card by CUDA: a kernel a stage, the kernels of a block of steps in one graph. Compiled without contraction, so that the bits
// are those of the emulation.
#include <cuda_runtime.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <string_view>

#include "feldspar/base/error.hpp"
#include "feldspar/gpu/backend.hpp"
#include "feldspar/gpu/cuda_kernels.cuh"

namespace feldspar {
namespace {

[[noreturn]] void fail(cudaError_t error, const char* doing) {
    cudaGetLastError();  // it is told here
    throw InputError({.key = "--device"},
                     std::string("the graphics card failed while ") + doing + ": " + cudaGetErrorString(error), "cpu, or auto",
                     "look at the card with nvidia-smi, or run on the processor");
}
void require(cudaError_t error, const char* doing) {
    if (error != cudaSuccess) fail(error, doing);
}

int blocks_of(int size, int threads) { return (threads + size - 1) / size; }

class CudaBackend final : public Backend {
public:
    CudaBackend(int multiprocessors, bool in_one_kernel) : multiprocessors_(multiprocessors), in_one_kernel_(in_one_kernel) {
        require(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "a stream was made");
    }
    ~CudaBackend() override {
        cudaStreamSynchronize(stream_);
        if (graph_ != nullptr) cudaGraphExecDestroy(graph_);
        cudaStreamDestroy(stream_);
    }

    void* allocate(std::size_t bytes) override {
        void* memory = nullptr;
        const cudaError_t error = cudaMallocAsync(&memory, bytes, stream_);
        if (error == cudaErrorMemoryAllocation) {
            cudaGetLastError();
            std::size_t free_bytes = 0, all = 0;
            cudaMemGetInfo(&free_bytes, &all);
            throw InputError({.key = "--device"},
                             "the memory of the graphics card is too small for what runs on it: " +
                                 std::to_string(free_bytes >> 20) + " MiB of " + std::to_string(all >> 20) + " MiB are free",
                             "cpu, or auto", "fewer tests at once (--jobs), a smaller specimen, or the processor");
        }
        require(error, "memory was taken");
        return memory;
    }
    void free(void* memory) override {
        if (memory != nullptr) cudaFreeAsync(memory, stream_);
    }
    void* allocate_beside(std::size_t bytes) override {
        void* memory = nullptr;
        require(cudaMallocHost(&memory, bytes), "memory for copies was taken");
        return memory;
    }
    void free_beside(void* memory) override {
        if (memory != nullptr) cudaFreeHost(memory);
    }
    void upload(void* to, const void* from, std::size_t bytes) override {
        require(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream_), "arrays went up");
    }
    void download(void* to, const void* from, std::size_t bytes) override {
        require(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream_), "arrays came back");
    }
    void finish() override { require(cudaStreamSynchronize(stream_), "steps were made"); }

    void write_lines(const DeviceArrays& a, const LaunchSizes& sizes) override {
        if (sizes.grain_blocks > 0) {
            if (sizes.grain_threads == 128)
                grain_lines_kernel<128><<<sizes.grain_blocks, 128, 0, stream_>>>(a);
            else
                grain_lines_kernel<256><<<sizes.grain_blocks, 256, 0, stream_>>>(a);
        }
        if (a.rigid_count > 0) rigid_lines_kernel<<<blocks_of(kMostThreads, a.rigid_count), kMostThreads, 0, stream_>>>(a);
        require(cudaGetLastError(), "a kernel began");
    }

    void run(const DeviceArrays& a, const LaunchSizes& sizes, bool local_damping, int count) override {
        if (in_one_kernel_ && sizes.grain_threads == kStepsThreads)
            return local_damping ? run_in_one_kernel<true>(a, sizes, count) : run_in_one_kernel<false>(a, sizes, count);
        if (graph_ == nullptr || count != count_ || local_damping != local_ || !(sizes == sizes_) ||
            std::memcmp(&a, arrays_, sizeof a) != 0) {
            cudaGraph_t graph = nullptr;
            require(cudaStreamBeginCapture(stream_, cudaStreamCaptureModeThreadLocal), "steps were noted");
            for (int k = 0; k < count; ++k) local_damping ? step<true>(a, sizes, k) : step<false>(a, sizes, k);
            reaction_kernel<<<1, kMostThreads, 0, stream_>>>(a);
            require(cudaStreamEndCapture(stream_, &graph), "steps were noted");
            if (graph_ != nullptr) {
                cudaGraphExecUpdateResultInfo info{};
                if (cudaGraphExecUpdate(graph_, graph, &info) != cudaSuccess) {
                    cudaGetLastError();
                    cudaGraphExecDestroy(graph_);
                    graph_ = nullptr;
                }
            }
            if (graph_ == nullptr) require(cudaGraphInstantiate(&graph_, graph, 0), "steps were prepared");
            cudaGraphDestroy(graph);
            std::memcpy(arrays_, &a, sizeof a);
            sizes_ = sizes;
            local_ = local_damping;
            count_ = count;
        }
        require(cudaGraphLaunch(graph_, stream_), "steps began");
    }

private:
    template <bool local>
    void run_in_one_kernel(DeviceArrays a, const LaunchSizes& sizes, int count) {
        const auto kernel = a.rigid_count > 0 ? steps_kernel<local, true> : steps_kernel<local, false>;
        int resident = 0;
        require(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&resident, kernel, kStepsThreads, 0),
                "it was asked how much it holds");
        const int wanted = std::max({sizes.grain_blocks, blocks_of(kStepsThreads, kMostLanes * a.contact_pack_count),
                                     blocks_of(kStepsThreads, a.rigid_count), 1});
        int grain_blocks = sizes.grain_blocks;
        void* parameters[] = {&a, &grain_blocks, &count};
        require(cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(kernel),
                                            dim3(static_cast<unsigned>(std::min(wanted, resident * multiprocessors_))),
                                            dim3(kStepsThreads), parameters, 0, stream_),
                "steps began");
    }

    template <bool local>
    void step(const DeviceArrays& a, const LaunchSizes& sizes, int k) {
        const int size = sizes.other_threads;
        const int blocks = blocks_of(size, kMostLanes * a.contact_pack_count) + 1;
        bool reaction = k > 0;
        if (!a.loose_contacts.empty()) loose_contacts_kernel<<<blocks_of(size, a.loose_contacts.count), size, 0, stream_>>>(a, k);
        if (a.has_flexible_contacts) {
            if (sizes.uneven)
                contacts_kernel<false, true><<<blocks, size, 0, stream_>>>(a, k, reaction);
            else
                contacts_kernel<false, false><<<blocks, size, 0, stream_>>>(a, k, reaction);
            reaction = false;
        }
        if (a.has_rigid_contacts) {
            if (sizes.uneven)
                contacts_kernel<true, true><<<blocks, size, 0, stream_>>>(a, k, reaction);
            else
                contacts_kernel<true, false><<<blocks, size, 0, stream_>>>(a, k, reaction);
            reaction = false;
        }
        if (reaction) reaction_kernel<<<1, kMostThreads, 0, stream_>>>(a);
        if (sizes.grain_blocks > 0) {
            if (sizes.grain_threads == 128)
                grains_kernel<local, 128><<<sizes.grain_blocks, 128, 0, stream_>>>(a, k);
            else
                grains_kernel<local, 256><<<sizes.grain_blocks, 256, 0, stream_>>>(a, k);
        }
        const int rigid_blocks = blocks_of(size, a.rigid_count), plate_blocks = blocks_of(size, a.plates.count);
        if (rigid_blocks + plate_blocks > 0)
            rigid_kernel<local><<<rigid_blocks + plate_blocks, size, 0, stream_>>>(a, k, rigid_blocks);
    }

    int multiprocessors_;
    bool in_one_kernel_;
    cudaStream_t stream_ = nullptr;
    cudaGraphExec_t graph_ = nullptr;  // of the steps noted last
    alignas(DeviceArrays) char arrays_[sizeof(DeviceArrays)]{};
    LaunchSizes sizes_;
    bool local_ = false;
    int count_ = 0;
};

std::string version_text(int version) { return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10); }

}  // namespace

bool built_for_cards() { return true; }

std::unique_ptr<Backend> cuda_backend(DeviceProvenance& provenance) {
    static std::once_flag
        once;  // queues of the card, so that tests do not wait behind each other: read when the first call wakes the driver
    std::call_once(once, [] { setenv("CUDA_DEVICE_MAX_CONNECTIONS", "32", 0); });
    int driver = 0, count = 0;
    cudaDriverGetVersion(&driver);
    const cudaError_t error = cudaGetDeviceCount(&count);
    if (error != cudaSuccess || count == 0) {
        cudaGetLastError();
        throw InputError({.key = "--device"},
                         driver == 0 ? "there is no graphics card here, or no driver for it"
                                     : std::string("no graphics card can be used here: ") + cudaGetErrorString(error),
                         "cpu, or auto", "run on the processor, or on a machine with an NVIDIA card and its driver");
    }
    int number = 0;
    cudaDeviceProp card{};
    require(cudaGetDevice(&number), "it was looked for");
    require(cudaGetDeviceProperties(&card, number), "it was asked what it is");
    provenance = {"gpu",
                  card.name,
                  version_text(driver),
                  std::to_string(card.major) + "." + std::to_string(card.minor),
                  "double",
                  static_cast<double>(card.totalGlobalMem)};
    // Until it is measured which is better when, the graph is the rule.
    const char* kernels = std::getenv("FELDSPAR_CARD_KERNELS");
    return std::make_unique<CudaBackend>(card.multiProcessorCount,
                                         kernels != nullptr && std::string_view(kernels) == "one" && card.cooperativeLaunch != 0);
}

}  // namespace feldspar
