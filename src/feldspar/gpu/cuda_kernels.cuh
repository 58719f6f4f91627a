// The kernels of a step: what a thread does stands in step_text.hpp. Included by cuda_backend.cu alone.
#pragma once

#include <cooperative_groups.h>

#include "feldspar/gpu/step_text.hpp"

namespace feldspar {
namespace {

constexpr int kMostThreads = 128;  // of a block of contacts, rigid bodies, plates

__device__ __forceinline__ int thread_here() { return static_cast<int>(threadIdx.x); }
__device__ __forceinline__ int thread_of_all() { return static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x); }

__device__ void reaction_of_block(const DeviceArrays& a) {
    __shared__ double sums[kReactionThreads];
    for (int t = thread_here(); t < kReactionThreads; t += static_cast<int>(blockDim.x)) sums[t] = reaction_thread(a, t);
    for (int half = kReactionThreads / 2; half > 0; half /= 2) {
        __syncthreads();
        for (int t = thread_here(); t < half; t += static_cast<int>(blockDim.x)) sums[t] += sums[t + half];
    }
    if (threadIdx.x == 0) add_work(a, sums[0]);
}

// The contacts of packs; the last block adds up what the loading did in the step before, if there was one.
template <bool rigid, bool uneven>
__global__ void __launch_bounds__(kMostThreads) contacts_kernel(const __grid_constant__ DeviceArrays a, int k, bool reaction) {
    if (blockIdx.x + 1 == gridDim.x) {
        if (reaction) reaction_of_block(a);
    } else {
        contact_thread<rigid, uneven>(a, step_number(a, k), thread_of_all());
    }
}

__global__ void __launch_bounds__(kMostThreads) loose_contacts_kernel(const __grid_constant__ DeviceArrays a, int k) {
    loose_contact_thread(a, step_number(a, k), thread_of_all());
}

__global__ void __launch_bounds__(kMostThreads) reaction_kernel(const __grid_constant__ DeviceArrays a) { reaction_of_block(a); }

// The threads of block `number` of the grains' stage.
template <bool local>
__device__ __forceinline__ void grains_of_block(const DeviceArrays& a, const KernelStep& step, const GrainBlock& block,
                                                int number) {
    EdgeWork w;
    w.at = a.edge_threads[number * block.threads + thread_here()];
    if (a.model.pressed) {
        press_grain(a, step, w);
        __syncthreads();
    }
    load_edge(a, block, thread_here(), w);
    __syncthreads();
    Real2 to_corner, to_centre;
    force_edge(a, block, w, to_corner, to_centre);
    __syncthreads();
    give_forces(block, thread_here(), w, to_corner, to_centre);
    __syncthreads();
    move_edge<local>(a, step, block, w);
    __syncthreads();
    show_edge(a, block, thread_here(), w);
    __syncthreads();
    end_edge<true>(a, step, block, thread_here(), w);
}

template <bool local, int threads>
__global__ void __launch_bounds__(threads) grains_kernel(const __grid_constant__ DeviceArrays a, int k) {
    __shared__ double shared[kSharedQuantities * threads];
    grains_of_block<local>(a, step_number(a, k), GrainBlock{shared, threads}, static_cast<int>(blockIdx.x));
}

// A block of steps in one kernel: all its blocks of threads are on the card together and wait for each other after each stage.
// For specimens that do not fill the card, whose steps are as short as the way from one kernel to the next.
constexpr int kStepsThreads = 128;
template <bool local, bool rigid>
__global__ void __launch_bounds__(kStepsThreads)
    steps_kernel(const __grid_constant__ DeviceArrays a, int grain_blocks, int count) {
    constexpr int threads = kStepsThreads;
    __shared__ double shared[kSharedQuantities * threads];
    const cooperative_groups::grid_group grid = cooperative_groups::this_grid();
    const GrainBlock block{shared, threads};
    const int blocks = static_cast<int>(gridDim.x), here = static_cast<int>(blockIdx.x), stride = blocks * threads;
    const int first = ((thread_here() / 32) * blocks + here) * 32 + thread_here() % 32;  // warp by warp to all blocks in turn
    for (int k = 0; k < count; ++k) {
        const KernelStep step = step_number(a, k);
        for (int t = first; t < kMostLanes * a.contact_pack_count; t += stride) {
            if (a.has_flexible_contacts) contact_thread<false, true>(a, step, t);
            if constexpr (rigid) contact_thread<true, true>(a, step, t);
        }
        for (int t = first; t < a.loose_contacts.count; t += stride) loose_contact_thread(a, step, t);
        if (here == blocks - 1 && k > 0) {
            __syncthreads();
            reaction_of_block(a);
        }
        grid.sync();
        for (int number = here; number < grain_blocks; number += blocks) {
            __syncthreads();  // the block before has read what it shared
            grains_of_block<local>(a, step, block, number);
        }
        if constexpr (rigid)
            for (int t = first; t < a.rigid_count; t += stride) rigid_thread<local>(a, step, t);
        for (int t = first; t < a.plates.count; t += stride) plate_thread(a, step, t);
        grid.sync();
    }
    if (here == 0) reaction_of_block(a);
}

template <int threads>
__global__ void __launch_bounds__(threads) grain_lines_kernel(const __grid_constant__ DeviceArrays a) {
    __shared__ double shared[kSharedQuantities * threads];
    const GrainBlock block{shared, threads};
    EdgeWork w;
    w.at = a.edge_threads[thread_of_all()];
    load_motion_of_edge(a, w);
    show_edge(a, block, thread_here(), w);
    __syncthreads();
    end_edge<false>(a, KernelStep{}, block, thread_here(), w);
}

// Rigid bodies, then plates.
template <bool local>
__global__ void __launch_bounds__(kMostThreads) rigid_kernel(const __grid_constant__ DeviceArrays a, int k, int rigid_blocks) {
    const KernelStep step = step_number(a, k);
    if (static_cast<int>(blockIdx.x) < rigid_blocks)
        rigid_thread<local>(a, step, thread_of_all());
    else
        plate_thread(a, step, thread_of_all() - rigid_blocks * static_cast<int>(blockDim.x));
}

__global__ void __launch_bounds__(kMostThreads) rigid_lines_kernel(const __grid_constant__ DeviceArrays a) {
    rigid_line_thread(a, thread_of_all());
}

}  // namespace
}  // namespace feldspar
