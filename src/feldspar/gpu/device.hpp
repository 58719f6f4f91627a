// The gpu room: the steps of a test on a graphics card. What a card does is the text of the vector kernels with a lane a thread
// (step_text.hpp), so the law, the geometry of contacts and the triangles stand once. Nothing outside this room knows of CUDA.
//
// The state lives on the card from one block of steps to the next. Before a block what the processor has changed goes up, behind
// it what the steps have changed comes back; within a block nothing does. The bits are the same for any size of blocks of
// threads, any division into blocks of steps and any company on the card, and the same as those of the emulation.
#pragma once

#include <memory>
#include <string>

#include "feldspar/step/step.hpp"

namespace feldspar {

/// What computes: for whoever reads the results.
struct DeviceProvenance {
    std::string kind;        ///< "gpu", "emulation"
    std::string card;        ///< "NVIDIA H100 80GB HBM3"
    std::string driver;      ///< CUDA version that the driver knows: "13.0"
    std::string capability;  ///< compute capability: "9.0"
    std::string precision = "double";
    double memory_bytes = 0.0;
};

/// Whether the program was built with support for cards.
bool built_for_cards();

/// What there is here; with the environment variable FELDSPAR_EMULATED_CARD, MiB of its memory, the emulation instead. @throws
/// InputError that says why a card cannot be used: none, or no support in this program
DeviceProvenance card_here();

/// A device for one test on the card. @throws InputError as card_here()
std::unique_ptr<StepDevice> open_card();

/// The same steps by loops on the processor, for tests.
std::unique_ptr<StepDevice> open_emulation();

/// What of an assembly a device does not know, as a sentence; empty: it knows everything.
std::string not_ported(const Assembly& assembly);

/// Bytes that a test takes on a card, about.
double card_bytes(const Assembly& assembly);

}  // namespace feldspar
