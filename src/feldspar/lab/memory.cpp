#include "feldspar/lab/memory.hpp"

#include <algorithm>

#include "feldspar/base/heap_bytes.hpp"
#include "feldspar/lab/foresee.hpp"

namespace feldspar {

double memory_of(const Specimen& specimen) {
    constexpr double kHeapBlock = 16.0;                                           // what an allocation takes besides
    const double lists = 4.0 * static_cast<double>(specimen.cells.cells.size());  // of cells, each an allocation
    return heap_bytes(specimen.packing) + heap_bytes(specimen.packed) + heap_bytes(specimen.cells) + heap_bytes(specimen.mesh) +
           heap_bytes(specimen.filling) + heap_bytes(specimen.crystal_of_cell) + kHeapBlock * lists;
}

Foreseen memory_of_run(const TestSetup& setup, const Assembly& assembly, const Foreseen& steps) {
    // Code, libraries, stacks, the tables and buffers of files: what runs of 180 to 470 grains take beside the rest.
    constexpr double kProgram = 38e6;
    // A row of the history, in a list that grows by doubling, and its line in the file, in a text that does.
    constexpr double kDoubling = 2.0, kLine = 440.0;
    constexpr int kStates = 2;  // of the body, to which a test with adaptive numerics may go back (load.cpp)
    const Specimen& specimen = *setup.specimen;
    // What the recorder holds of a snapshot while the test runs: start, first crack, peak, end, and up to twice those asked for.
    const double raw = static_cast<double>(assembly.nodes.count()) * sizeof(Vec2) +
                       static_cast<double>(assembly.points.size()) * (sizeof(float) + sizeof(double)) +
                       (assembly.triangles.empty() ? static_cast<double>(specimen.cells.cells.size()) * sizeof(Mat2) : 0.0);
    const double held = 4.0 + 2.0 * setup.test.snapshots;
    // And of one that is complete: displacements of the mesh; three stresses and the damage of a triangle, in lists that grew by
    // doubling.
    const double triangles = static_cast<double>(specimen.mesh.triangles.size());
    const double complete =
        static_cast<double>(specimen.mesh.nodes.size()) * sizeof(Vec2) + triangles * (3.0 * 1.5 * sizeof(double) + sizeof(float));
    const double kept = 4.0 + setup.test.snapshots;
    // The states are there while the test loads, complete fields when it has ended: the larger of both counts.
    const double body = assembly.memory_bytes();
    const double states = setup.numerics.kind == NumericsKind::adaptive ? kStates * body : 0.0;
    const double whole = kProgram + memory_of(specimen) + body + held * raw + std::max(states, kept * complete);
    const auto with_rows = [&](double made) {
        return whole + kDoubling * (sizeof(HistoryRow) + kLine) * made / steps_per_row(setup.numerics);
    };
    return {with_rows(steps.low), with_rows(steps.usual), with_rows(steps.high)};
}

}  // namespace feldspar
