// The kernels of a step: what a thread does stands in step_text.hpp. Included by cuda_backend.cu alone.
#pragma once

#include "feldspar/gpu/step_text.hpp"

namespace feldspar {
namespace {

constexpr int kMostThreads = 128;   // of a block of contacts, rigid bodies, plates

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

__global__ void __launch_bounds__(kMostThreads) loose_contacts_kernel(const __grid_constant__ DeviceArrays a, int k) { loose_contact_thread(a, step_number(a, k), thread_of_all()); }

__global__ void __launch_bounds__(kMostThreads) reaction_kernel(const __grid_constant__ DeviceArrays a) { reaction_of_block(a); }

template <bool local, int threads>
__global__ void __launch_bounds__(threads) grains_kernel(const __grid_constant__ DeviceArrays a, int k) {
    __shared__ double shared[kSharedQuantities * threads];
    const GrainBlock block{shared, threads};
    const KernelStep step = step_number(a, k);
    EdgeWork w;
    w.at = a.edge_threads[thread_of_all()];
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
    if (static_cast<int>(blockIdx.x) < rigid_blocks) rigid_thread<local>(a, step, thread_of_all());
    else plate_thread(a, step, thread_of_all() - rigid_blocks * static_cast<int>(blockDim.x));
}

__global__ void __launch_bounds__(kMostThreads) rigid_lines_kernel(const __grid_constant__ DeviceArrays a) { rigid_line_thread(a, thread_of_all()); }

}  // namespace
}  // namespace feldspar
