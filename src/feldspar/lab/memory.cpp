#include "feldspar/lab/memory.hpp"

#include "feldspar/base/heap_bytes.hpp"

namespace feldspar {

double memory_of(const Specimen& specimen) {
    constexpr double kHeapBlock = 16.0;                                           // what an allocation takes besides
    const double lists = 4.0 * static_cast<double>(specimen.cells.cells.size());  // of cells, each an allocation
    return heap_bytes(specimen.packing) + heap_bytes(specimen.packed) + heap_bytes(specimen.cells) + heap_bytes(specimen.mesh) +
           heap_bytes(specimen.filling) + heap_bytes(specimen.crystal_of_cell) + kHeapBlock * lists;
}

double memory_of_run(const Specimen& specimen, const Assembly& assembly, const TestSpec& test) {
    constexpr double kProgram =
        27e6;  // code, libraries, stacks, the writing of small files: a run of 150 rigid grains takes 32 MB
    constexpr double kHeapOverArrays =
        1.25;  // with what the heap does not give back and the writing of files; measured on 5,000 and 20,000 grains
    // what the recorder holds of a snapshot while the test runs: start, first crack, peak, end, and up to twice those asked for
    const double raw = static_cast<double>(assembly.nodes.count()) * sizeof(Vec2) +
                       static_cast<double>(assembly.points.size()) * (sizeof(float) + sizeof(double)) +
                       (assembly.triangles.empty() ? static_cast<double>(specimen.cells.cells.size()) * sizeof(Mat2) : 0.0);
    const double held = 4.0 + 2.0 * test.snapshots;
    // and of one that is complete: displacements of the mesh; three stresses and the damage of a triangle, in lists that grew by
    // doubling
    const double triangles = static_cast<double>(specimen.mesh.triangles.size());
    const double complete =
        static_cast<double>(specimen.mesh.nodes.size()) * sizeof(Vec2) + triangles * (3.0 * 1.5 * sizeof(double) + sizeof(float));
    const double kept = 4.0 + test.snapshots;
    return kProgram + kHeapOverArrays * (memory_of(specimen) + assembly.memory_bytes() + held * raw + kept * complete);
}

}  // namespace feldspar
