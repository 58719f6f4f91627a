// Edits of the file of a kept state: its head, its state and its checksum.
#include "feldspar/output/checkpoints.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

void checkpoint_file(std::string_view input) {
    static const CheckpointOwner owner{"test", "0.1.0 commit", "portable"};
    static const std::string whole = [] {
        const TemporaryFolder folder;
        write_checkpoint(RunDirectory::open(folder.path()), "state", owner,
                         [](const StatePut& put) { put("a state of some bytes", 21); });
        return read_text(folder / "state");
    }();
    const std::filesystem::path file = file_with("state", edited(whole, input));
    const Checkpoint found = read_checkpoint(file.parent_path(), "state", owner);
    if (found.state.empty() == found.refused.empty()) throw Fault("a state is neither taken nor refused");
}

}  // namespace feldspar::fuzz
