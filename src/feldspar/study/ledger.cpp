#include "feldspar/study/ledger.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "feldspar/base/error.hpp"
#include "feldspar/study/text_hash.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

constexpr int schema_version = 1;         // PRAGMA user_version
constexpr int busy_timeout_ms = 120'000;  // another program's transaction is over long before
constexpr std::int64_t silent_s = 600;    // a process of another machine that has not been heard of for so long may be gone

std::int64_t now_s() {
    return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string host() {
    char name[256] = {};
    return ::gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

// When a process of this machine began, in clock ticks since the machine did; empty if there is none. With the number of the
// process it is unique while the machine runs.
std::string beginning_of(const std::string& pid) {
    std::ifstream file("/proc/" + pid + "/stat");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    const auto name_end = text.rfind(')');
    if (name_end == std::string::npos) return {};
    std::stringstream rest(text.substr(name_end + 1));
    std::string word;
    for (int field = 3; field <= 22; ++field) rest >> word;
    return word;
}

// "machine pid beginning"
std::string this_process() {
    const std::string pid = std::to_string(::getpid());
    return host() + " " + pid + " " + beginning_of(pid);
}

// Whether the processes that hold runs are still there.
class Holders {
public:
    explicit Holders(std::chrono::milliseconds watched) : watched_(watched) {}

    bool alive(const std::string& holder, std::int64_t last_heard_s) {
        std::stringstream words(holder);
        std::string machine, pid, beginning;
        words >> machine >> pid >> beginning;
        if (machine == host()) return !beginning.empty() && beginning_of(pid) == beginning;
        if (std::abs(now_s() - last_heard_s) < silent_s) return true;
        // Clocks of two machines may differ, and jump. So it is gone only if it says nothing while this process watches, by a
        // clock that does not jump.
        const auto now = std::chrono::steady_clock::now();
        const auto [seen, first] = seen_.try_emplace(holder, Seen{last_heard_s, now});
        if (!first && seen->second.heard_s != last_heard_s) seen->second = {last_heard_s, now};
        return first || now - seen->second.since < watched_;
    }

private:
    struct Seen {
        std::int64_t heard_s = 0;
        std::chrono::steady_clock::time_point since;
    };
    std::chrono::milliseconds watched_;
    std::map<std::string, Seen> seen_;
};

std::string columns(const char* type, const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += fmt::format(", {} {}", name, type);
    return text;
}

std::string all_columns() {
    return fmt::format("id, state, reason, test, sigma3_Pa, seed, {}, {}, job, holder, heard", fmt::join(number_columns(), ", "),
                       fmt::join(text_columns(), ", "));
}

void bind(SQLite::Statement& statement, int at, double value) {
    if (std::isfinite(value))
        statement.bind(at, value);
    else
        statement.bind(at);  // NULL
}

double number_in(const SQLite::Column& column) {
    return column.isNull() ? std::numeric_limits<double>::quiet_NaN() : column.getDouble();
}

}  // namespace

namespace {
constexpr const char* way_out = "move the file away, and the same command makes it again from the directories of the runs";
}

struct Ledger::Database {
    fs::path directory;
    std::string name;         // of the file
    struct stat identity {};  // of the file, as it was first seen
    std::string me = this_process();
    Holders holders;
    std::set<std::string> failed_here;  // for good, recorded by this object
    SQLite::Database file;

    Database(const fs::path& directory_, const std::string& name_, int flags, std::chrono::milliseconds watched)
        : directory(directory_), name(name_), holders(watched), file(name, flags, busy_timeout_ms) {
        must_be_there();
    }

    // What is written to a file that was removed or moved away would be lost. @throws OutputError
    void must_be_there() {
        if (name == ":memory:") return;
        struct stat now {};
        if (::stat(name.c_str(), &now) != 0)
            throw OutputError(fmt::format("the ledger '{}' is not there any more: {}", name, std::strerror(errno)));
        if (identity.st_ino == 0) identity = now;
        if (now.st_ino != identity.st_ino || now.st_dev != identity.st_dev)
            throw OutputError(
                fmt::format("the ledger '{}' is not the file any more that it was: something has replaced it", name));
    }

    void make() {
        SQLite::Transaction transaction(file, SQLite::TransactionBehavior::IMMEDIATE);
        file.exec(fmt::format(
            "CREATE TABLE IF NOT EXISTS run (id TEXT PRIMARY KEY, state TEXT NOT NULL, reason TEXT, test TEXT NOT NULL, "
            "sigma3_Pa REAL, seed INTEGER{}{}, job TEXT, holder TEXT, heard INTEGER) WITHOUT ROWID",
            columns("REAL", number_columns()), columns("TEXT", text_columns())));
        file.exec("CREATE TABLE IF NOT EXISTS study (name TEXT PRIMARY KEY, title TEXT, file TEXT, text TEXT)");
        file.exec(
            "CREATE TABLE IF NOT EXISTS member (study TEXT NOT NULL, run TEXT NOT NULL, point INTEGER NOT NULL, axis TEXT NOT "
            "NULL, "
            "label TEXT, number REAL, PRIMARY KEY (study, run, point, axis)) WITHOUT ROWID");
        add_missing_columns();
        file.exec(fmt::format("PRAGMA user_version = {}", schema_version));
        transaction.commit();
    }

    // Columns that this version of the program knows and the one that made the ledger did not.
    void add_missing_columns() {
        std::vector<std::string> there;
        SQLite::Statement info(file, "PRAGMA table_info(run)");
        while (info.executeStep()) there.push_back(info.getColumn(1).getString());
        const auto add = [&](const char* type, const std::vector<std::string>& names) {
            for (const std::string& column : names)
                if (std::find(there.begin(), there.end(), column) == there.end())
                    file.exec(fmt::format("ALTER TABLE run ADD COLUMN {} {}", column, type));
        };
        add("REAL", number_columns());
        add("TEXT", text_columns());
        add("TEXT", {"checksum"});
    }

    // Of all that a row says but for who is at it and when, whichever version of the program has written it. SQLite itself finds
    // pages that are no pages, but not a digit that has changed.
    std::string checksum_of(const std::string& id) {
        SQLite::Statement row(file, "SELECT * FROM run WHERE id = ?");
        row.bind(1, id);
        if (!row.executeStep()) return {};
        std::map<std::string, std::string> values;
        for (int at = 0; at < row.getColumnCount(); ++at) {
            const SQLite::Column column = row.getColumn(at);
            const std::string key = column.getName();
            if (column.isNull() || key == "checksum" || key == "holder" || key == "heard") continue;
            values[key] = column.isFloat() ? fmt::format("{}", column.getDouble()) : column.getString();
        }
        std::string text;
        for (const auto& [key, value] : values) text += fmt::format("{} {} {}\n", key, value.size(), value);
        return hash_of_text(text);
    }

    // A row without a checksum is of an earlier version. @throws OutputError if a row is not what was written
    void check(const std::string& id) {
        SQLite::Statement look(file, "SELECT checksum FROM run WHERE id = ? AND checksum IS NOT NULL");
        look.bind(1, id);
        if (look.executeStep() && look.getColumn(0).getString() != checksum_of(id))
            throw OutputError(fmt::format("the ledger '{}' is damaged: the row of run {} is not what was written; {}",
                                          (directory / "ledger.sqlite").string(), id, way_out));
    }

    void write(const RunRecord& record) {
        const std::size_t count = 9 + number_columns().size() + text_columns().size();
        SQLite::Statement insert(file, fmt::format("INSERT OR REPLACE INTO run ({}) VALUES ({})", all_columns(),
                                                   fmt::join(std::vector<std::string>(count, "?"), ", ")));
        int at = 0;
        insert.bind(++at, record.id);
        insert.bind(++at, feldspar::name(record.state));
        insert.bind(++at, record.reason);
        insert.bind(++at, record.test);
        bind(insert, ++at, record.sigma3_Pa);
        insert.bind(++at, static_cast<std::int64_t>(record.seed));
        for (const std::string& column : number_columns()) {
            const auto found = record.numbers.find(column);
            bind(insert, ++at, found == record.numbers.end() ? std::nan("") : found->second);
        }
        for (const std::string& column : text_columns()) {
            const auto found = record.texts.find(column);
            if (found == record.texts.end())
                insert.bind(++at);
            else
                insert.bind(++at, found->second);
        }
        insert.bind(++at, record.job);
        insert.bind(++at, me);
        insert.bind(++at, now_s());
        insert.exec();
        SQLite::Statement sign(file, "UPDATE run SET checksum = ? WHERE id = ?");
        sign.bind(1, checksum_of(record.id));
        sign.bind(2, record.id);
        sign.exec();
    }

    RunRecord read(SQLite::Statement& row) const {
        RunRecord record;
        int at = 0;
        record.id = row.getColumn(at++).getString();
        const std::string state = row.getColumn(at++).getString();
        record.state = state == "done" ? RunState::done : state == "failed" ? RunState::failed : RunState::running;
        record.reason = row.getColumn(at++).getString();
        record.test = row.getColumn(at++).getString();
        record.sigma3_Pa = number_in(row.getColumn(at++));
        record.seed = static_cast<std::uint64_t>(row.getColumn(at++).getInt64());
        for (const std::string& column : number_columns()) record.numbers[column] = number_in(row.getColumn(at++));
        for (const std::string& column : text_columns()) {
            const SQLite::Column text = row.getColumn(at++);
            if (!text.isNull()) record.texts[column] = text.getString();
        }
        record.job = row.getColumn(at++).getString();
        return record;
    }
};

namespace {

// SQLite's own words about a ledger, with its place, and what helps if it is damaged.
std::string reason_of(const fs::path& file, const SQLite::Exception& problem) {
    const bool damaged =
        problem.getErrorCode() == 1 || problem.getErrorCode() == 11;  // SQLITE_ERROR (tables are not ours), SQLITE_CORRUPT
    return fmt::format("the ledger '{}': {}{}{}", file.string(), problem.what(), damaged ? "; if it is damaged, " : "",
                       damaged ? way_out : "");
}

template <class Action>
auto guarded(const fs::path& directory, Action action) {
    try {
        return action();
    } catch (const SQLite::Exception& problem) {
        throw OutputError(reason_of(directory / "ledger.sqlite", problem));
    }
}

// The change of the journal needs the whole file, and does not wait for it by itself: of two programs that make a ledger at the
// same moment one would be told that it is locked.
void let_readers_and_writers_side_by_side(SQLite::Database& file) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(busy_timeout_ms);
    while (true) {
        try {
            file.exec("PRAGMA journal_mode = WAL");
            return;
        } catch (const SQLite::Exception& problem) {
            constexpr int busy = 5;  // SQLITE_BUSY
            if (problem.getErrorCode() != busy || std::chrono::steady_clock::now() > end) throw;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

}  // namespace

Ledger::Ledger(const fs::path& directory, Access access, std::chrono::milliseconds watched) {
    const fs::path file = directory / "ledger.sqlite";
    std::error_code error;
    if (access != Access::read)
        fs::create_directories(directory / "runs", error);
    else if (!fs::exists(file, error))
        throw InputError({}, fmt::format("there is no ledger in '{}': nothing of the study has been run", directory.string()));
    if (error) throw OutputError(fmt::format("cannot make the directory '{}': {}", directory.string(), error.message()));
    try {
        const int flags = SQLite::OPEN_READWRITE | (access == Access::read ? 0 : SQLite::OPEN_CREATE);
        database_ = std::make_unique<Database>(directory, access == Access::memory ? ":memory:" : file.string(), flags, watched);
        const int version = database_->file.execAndGet("PRAGMA user_version").getInt();
        if (version > schema_version)
            throw InputError({file.string(), 0, 0, {}}, "was made by a later version of this program",
                             fmt::format("the version that made it, or another `results`; if the file is damaged, {}", way_out));
        if (access == Access::write) {
            let_readers_and_writers_side_by_side(database_->file);
            database_->file.exec("PRAGMA synchronous = NORMAL");  // a power cut may lose the last rows; run.json has them
        }
        if (access != Access::read || version < schema_version)
            database_->make();
        else
            database_->add_missing_columns();
    } catch (const SQLite::Exception& problem) {
        if (problem.getErrorCode() == 26)
            throw InputError({file.string(), 0, 0, {}}, "is not a ledger, or is damaged", way_out);  // SQLITE_NOTADB
        throw OutputError(reason_of(file, problem));
    }
}

Ledger::~Ledger() = default;
Ledger::Ledger(Ledger&&) noexcept = default;

const fs::path& Ledger::directory() const { return database_->directory; }

fs::path Ledger::run_directory(const std::string& id) const { return database_->directory / "runs" / id; }

void Ledger::enrol(const Study& study) {
    guarded(directory(), [&] {
        SQLite::Database& file = database_->file;
        SQLite::Transaction transaction(file, SQLite::TransactionBehavior::IMMEDIATE);
        SQLite::Statement forget(file, "DELETE FROM member WHERE study = ?");
        forget.bind(1, study.name);
        forget.exec();
        SQLite::Statement note(file, "INSERT OR REPLACE INTO study (name, title, file, text) VALUES (?, ?, ?, ?)");
        note.bind(1, study.name);
        note.bind(2, study.title);
        note.bind(3, study.file.string());
        note.bind(4, study.text);
        note.exec();
        SQLite::Statement insert(
            file, "INSERT OR REPLACE INTO member (study, run, point, axis, label, number) VALUES (?, ?, ?, ?, ?, ?)");
        for (const Run& run : study.runs) {
            const std::size_t rows = std::max<std::size_t>(1, study.axes.size());  // without axes one row that says so
            for (std::size_t a = 0; a < rows; ++a) {
                insert.bind(1, study.name);
                insert.bind(2, run.id);
                insert.bind(3, static_cast<std::int64_t>(run.point));
                insert.bind(4, study.axes.empty() ? std::string{} : study.axes[a]);
                if (study.axes.empty()) {
                    insert.bind(5);
                    insert.bind(6);
                } else {
                    insert.bind(5, study.points[run.point].values[a].label);
                    bind(insert, 6, study.points[run.point].values[a].number);
                }
                insert.exec();
                insert.reset();
            }
        }
        transaction.commit();
    });
}

Ledger::Claim Ledger::claim(const Run& run, const Provenance* program) {
    return guarded(directory(), [&] {
        database_->must_be_there();
        SQLite::Database& file = database_->file;
        SQLite::Transaction transaction(file, SQLite::TransactionBehavior::IMMEDIATE);
        database_->check(run.id);
        {
            SQLite::Statement look(file, "SELECT state, holder, heard, failure, version, commit_id FROM run WHERE id = ?");
            look.bind(1, run.id);
            if (look.executeStep()) {
                const std::string state = look.getColumn(0).getString();
                if (state == "done") return Claim::done;
                if (state == "failed") {
                    RunRecord failed;
                    failed.state = RunState::failed;
                    for (int column = 3; column <= 5; ++column)
                        failed.texts[look.getColumn(column).getName()] = look.getColumn(column).getString();
                    if (database_->failed_here.contains(run.id) || (program != nullptr && failed_for_good(failed, *program)))
                        return Claim::failed;
                }
                if (state == "running" && database_->holders.alive(look.getColumn(1).getString(), look.getColumn(2).getInt64()))
                    return Claim::others;
            }
        }
        RunRecord record;
        record.id = run.id;
        record.test = name(run.test().kind);
        record.sigma3_Pa = run.test().sigma3_Pa;
        record.seed = run.seed();
        database_->write(record);
        transaction.commit();
        return Claim::ours;
    });
}

void Ledger::release(const std::string& id) {
    guarded(directory(), [&] {
        SQLite::Statement forget(database_->file, "DELETE FROM run WHERE id = ? AND state = 'running' AND holder = ?");
        forget.bind(1, id);
        forget.bind(2, database_->me);
        forget.exec();
    });
}

void Ledger::record(const RunRecord& record) {
    guarded(directory(), [&] {
        SQLite::Transaction transaction(database_->file, SQLite::TransactionBehavior::IMMEDIATE);
        {
            SQLite::Statement look(database_->file, "SELECT 1 FROM run WHERE id = ? AND state = 'done'");
            look.bind(1, record.id);
            if (look.executeStep()) return;
        }
        database_->write(record);
        transaction.commit();
        database_->must_be_there();
        const auto failure = record.texts.find("failure");
        if (record.state == RunState::failed && failure != record.texts.end() && failure->second != name(Failure::other))
            database_->failed_here.insert(record.id);
    });
}

void Ledger::heartbeat() {
    guarded(directory(), [&] {
        SQLite::Statement beat(database_->file, "UPDATE run SET heard = ? WHERE state = 'running' AND holder = ?");
        beat.bind(1, now_s());
        beat.bind(2, database_->me);
        beat.exec();
    });
}

bool Ledger::holds(const std::string& id) const {
    return guarded(directory(), [&] {
        SQLite::Statement look(database_->file, "SELECT 1 FROM run WHERE id = ? AND state = 'running' AND holder = ?");
        look.bind(1, id);
        look.bind(2, database_->me);
        return look.executeStep();
    });
}

std::optional<RunRecord> Ledger::find(const std::string& id) const {
    const auto found = find(std::span(&id, 1));
    return found.empty() ? std::nullopt : std::optional(found.front());
}

std::vector<RunRecord> Ledger::find(std::span<const std::string> ids) const {
    return guarded(directory(), [&] {
        SQLite::Transaction whole(database_->file);  // one moment for all of them
        SQLite::Statement look(database_->file, fmt::format("SELECT {} FROM run WHERE id = ?", all_columns()));
        std::vector<RunRecord> records;
        for (const std::string& id : ids) {
            look.bind(1, id);
            if (look.executeStep()) {
                database_->check(id);
                records.push_back(database_->read(look));
            }
            look.reset();
        }
        return records;
    });
}

}  // namespace feldspar
