// Edits of the bytes of a ledger (an SQLite file): pages or rows are damaged. It is read, and a run is claimed and recorded. A
// damaged ledger is an OutputError, too.
#include "feldspar/study/ledger.hpp"

#include "../small_study.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

namespace {

// With a run that is done, one that failed and one that is under way.
std::string whole_ledger(const Study& study) {
    const TemporaryFolder folder;
    {
        Ledger ledger(folder.path(), Ledger::Access::write);
        ledger.enrol(study);
        for (std::size_t i = 0; i + 1 < study.runs.size(); ++i) {
            RunRecord record;
            record.id = study.runs[i].id;
            record.test = "uniaxial-compression";
            record.state = i % 3 == 0 ? RunState::done : i % 3 == 1 ? RunState::failed : RunState::running;
            record.texts = {{"failure", "input"}, {"grade", "A"}};
            for (const std::string& column : number_columns()) record.numbers[column] = 1.5;
            ledger.record(record);
        }
    }
    return read_text(folder / "ledger.sqlite");
}

}  // namespace

void ledger(std::string_view input) {
    static const std::filesystem::path job = file_with("job.toml", small_job);
    static const Study study = parse_study("job = \"job.toml\"\nname = \"small\"\n", job.parent_path() / "study.toml");
    static const std::string whole = whole_ledger(study);
    const std::filesystem::path file = file_with("ledger.sqlite", edited(whole, input));
    for (const char* beside : {"-wal", "-shm", "-journal"}) std::filesystem::remove(file.string() + beside);
    std::vector<std::string> ids;
    for (const Run& run : study.runs) ids.push_back(run.id);
    const auto read_or_damaged = [](auto&& read) {
        try {
            read_or_refuse(read);
        } catch (const OutputError&) {
        }
    };
    read_or_damaged([&] {
        const Ledger ledger(file.parent_path(), Ledger::Access::read);
        for (const RunRecord& record : ledger.find(ids)) (void)result_of(record);
    });
    read_or_damaged([&] {
        Ledger ledger(file.parent_path(), Ledger::Access::write);
        ledger.enrol(study);
        (void)ledger.claim(study.runs.front());
        ledger.heartbeat();
        RunRecord record;
        record.id = study.runs.back().id;
        record.state = RunState::done;
        ledger.record(record);
        if (ledger.find(record.id)->state != RunState::done) throw Fault("a run that was recorded is not done");
    });
}

}  // namespace feldspar::fuzz
