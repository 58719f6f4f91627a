// Where the threads of a device run, and its memory: a card, or loops on the processor.
#pragma once

#include <cstddef>
#include <memory>

#include "feldspar/gpu/device.hpp"
#include "feldspar/gpu/device_arrays.hpp"

namespace feldspar {

/// How many threads a step takes.
struct LaunchSizes {
    int grain_threads = 128;  ///< of a block of the grains' stage: 128 or 256
    int grain_blocks = 0;
    int other_threads =
        128;  ///< of a block of the other stages; fewer for a small specimen, whose blocks are to reach the whole card
    bool uneven = false;  ///< there are contacts with laws of their own

    friend bool operator==(const LaunchSizes&, const LaunchSizes&) = default;
};

/// All copies and steps take place in the order of the calls.
class Backend {
public:
    Backend() = default;
    Backend(const Backend&) = delete;
    Backend& operator=(const Backend&) = delete;
    virtual ~Backend() = default;

    /// Memory of the device. @throws InputError if there is too little
    virtual void* allocate(std::size_t bytes) = 0;
    virtual void free(void* memory) = 0;
    /// Memory of the processor from which copies are fast.
    virtual void* allocate_beside(std::size_t bytes) = 0;
    virtual void free_beside(void* memory) = 0;

    virtual void upload(void* to, const void* from, std::size_t bytes) = 0;
    virtual void download(void* to, const void* from, std::size_t bytes) = 0;

    /// How everything moves, into the lines; then `count` steps.
    virtual void write_lines(const DeviceArrays& arrays, const LaunchSizes& sizes) = 0;
    virtual void run(const DeviceArrays& arrays, const LaunchSizes& sizes, bool local_damping, int count) = 0;
    /// Returns when all that was asked for is done.
    virtual void finish() = 0;
};

/// Loops on the processor: the same bits as a card, slowly.
std::unique_ptr<Backend> emulated_backend();

/// The card of this machine. @throws InputError if there is none, or the program was built without support for it
std::unique_ptr<Backend> cuda_backend(DeviceProvenance& provenance);

/// A device over a backend.
std::unique_ptr<StepDevice> device_over(std::unique_ptr<Backend> backend);

}  // namespace feldspar
