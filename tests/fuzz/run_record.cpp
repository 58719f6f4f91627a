// run.json of a run, as it is read back when a ledger is made anew. The checksum is taken out, so that what stands behind it is
// reached.
#include "feldspar/study/run_record.hpp"

#include "fuzz.hpp"

namespace feldspar::fuzz {

void run_record(std::string_view input) {
    const std::filesystem::path file = file_with("run.json", input);
    read_or_refuse([&] {
        const RunRecord record = read_record(file);
        (void)result_of(record);
        const std::filesystem::path again = file_with("run-again.json", to_json(record));
        (void)read_record(again);
    });
}

}  // namespace feldspar::fuzz
