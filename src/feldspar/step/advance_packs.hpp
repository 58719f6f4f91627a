// advance() with the kernels of fast/.
#pragma once

#include "feldspar/step/step.hpp"

namespace feldspar {

/// The settings as the kernels see them.
KernelStep kernel_step(const StepSettings& settings);

/// The stages of a step over parts of packs that are sorted out. Parts of one stage do not depend on each other.
class PackStages {
public:
    PackStages(Assembly& assembly, const StepSettings& settings, const KernelArrays& arrays)
        : assembly_(assembly), settings_(settings), arrays_(arrays) {}

    /// How the bodies move at present, into their lines: before the first step.
    void lines(const PackRanges& part) const;
    /// Stage 1.
    void contacts(const KernelStep& step, const PackRanges& part) const;
    /// Stage 2; writes the lines, too.
    void bodies(const KernelStep& step, const PackRanges& part) const;

    /// The same of one that is in no pack, by its number in the assembly.
    void loose_contact(const KernelStep& step, int contact) const;
    void loose_body(int body) const;
    void lines_of_loose(int body) const;

private:
    Assembly& assembly_;
    const StepSettings& settings_;
    const KernelArrays& arrays_;
};

/// Writes how everything moves into the lines of packs that are sorted out.
void write_lines(Assembly& assembly, Team& team, const StepSettings& settings, const KernelArrays& arrays);

/// `count` steps from lines that are written.
void advance_packs(Assembly& assembly, Team& team, const StepSettings& settings, const KernelArrays& arrays, long long first_step,
                   int count, PlatenWork& work);

}  // namespace feldspar
