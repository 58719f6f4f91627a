#include "feldspar/output/checkpoints.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/base/running_hash.hpp"
#include "feldspar/fast/kernels.hpp"

namespace feldspar {
namespace {

namespace fs = std::filesystem;

// A file is lines of text that say whose state it is, an empty line, the state, and a trailer by which a whole file is known.
constexpr std::string_view kFirstLine = "feldspar checkpoint 1";
constexpr const char* kCard = "card";
constexpr std::array<char, 8> kMark{'f', 'e', 'l', 'd', 's', 'p', 'a', 'r'};

struct Trailer {
    std::uint64_t bytes = 0, hash = 0;  // of all before it
    std::array<char, 8> mark = kMark;
};
static_assert(sizeof(Trailer) == 24);

std::string header_of(const CheckpointOwner& owner) {
    return fmt::format("{}\ntest {}\nversion {}\nkernels {}\n\n", kFirstLine, owner.test, owner.version, owner.kernels);
}

fs::path before_of(const fs::path& file) { return file.string() + ".before"; }

// The state in a file, or why there is none.
Checkpoint read_file(const fs::path& file, const CheckpointOwner& owner) {
    std::error_code error;
    const auto size = fs::file_size(file, error);
    if (error) return {};
    const auto no = [](std::string why) { return Checkpoint{{}, std::move(why)}; };
    Trailer trailer;
    if (size < sizeof trailer) return no("it is damaged");
    std::ifstream stream(file, std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(size - sizeof trailer));
    if (!stream.read(reinterpret_cast<char*>(&trailer), sizeof trailer)) return no("it cannot be read");
    if (trailer.mark != kMark || trailer.bytes != size - sizeof trailer)
        return no("it is damaged");  // before memory is asked for
    std::vector<char> bytes(trailer.bytes);
    stream.seekg(0);
    if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return no("it cannot be read");
    if (trailer.hash != hash_of_bytes(bytes.data(), bytes.size())) return no("it is damaged");
    const std::string wanted = header_of(owner);
    if (bytes.size() >= wanted.size() && std::equal(wanted.begin(), wanted.end(), bytes.begin())) {
        bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(wanted.size()));
        return {std::move(bytes), {}};
    }
    std::istringstream header(std::string(bytes.data(), std::min<std::size_t>(bytes.size(), 4096)));
    std::string first, key;
    std::getline(header, first);
    if (first != kFirstLine) return no("it is of another version of the program");
    CheckpointOwner found;
    for (std::string* value : {&found.test, &found.version, &found.kernels}) {
        header >> key >> std::ws;
        std::getline(header, *value);
    }
    if (found.test != owner.test) return no("it is another test's");
    if (found.version != owner.version)
        return no(fmt::format("version {} of the program has written it, this is {}", found.version, owner.version));
    if ((found.kernels == kCard) != (owner.kernels == kCard))
        return no(fmt::format("its steps were made on a {}: --device {} goes on with it",
                              found.kernels == kCard ? "graphics card" : "processor", found.kernels == kCard ? "gpu" : "cpu"));
    return no(fmt::format("it was computed with the instructions {}, here these are {}: FELDSPAR_KERNELS={} goes on with it",
                          found.kernels, owner.kernels, found.kernels));
}

}  // namespace

CheckpointOwner CheckpointOwner::of(const std::string& test, const Provenance& provenance) {
    return {test, provenance.version + " " + provenance.commit, provenance.device.empty() ? best_kernels().name : kCard};
}

void write_checkpoint(const RunDirectory& directory, const std::string& name, const CheckpointOwner& owner,
                      const std::function<void(const StatePut&)>& write) {
    const fs::path file = directory.path() / name;
    directory.write(name, [&](const fs::path& aside) {
        errno = 0;
        std::ofstream stream(aside, std::ios::binary);
        RunningHash hash;
        std::uint64_t written = 0;
        const auto put = [&](const void* data, std::size_t bytes) {
            hash.add(data, bytes);
            written += bytes;
            stream.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
        };
        const std::string header = header_of(owner);
        put(header.data(), header.size());
        write(put);
        const Trailer trailer{written, hash.digest(), kMark};
        stream.write(reinterpret_cast<const char*>(&trailer), sizeof trailer);
        stream.close();
        if (!stream) throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
        std::error_code ignored;  // there may be none before
        fs::rename(file, before_of(file), ignored);
    });
}

Checkpoint read_checkpoint(const fs::path& directory, const std::string& name, const CheckpointOwner& owner) {
    const fs::path file = directory / name;
    Checkpoint newest = read_file(file, owner);
    if (!newest.state.empty()) return newest;
    Checkpoint before = read_file(before_of(file), owner);
    if (!before.state.empty()) return before;  // what is wrong with the newest costs some minutes only
    return newest.refused.empty() ? before : newest;
}

void remove_checkpoint(const fs::path& directory, const std::string& name) {
    std::error_code ignored;
    fs::remove(directory / name, ignored);
    fs::remove(before_of(directory / name), ignored);
}

TestCheckpoints::TestCheckpoints(RunDirectory directory, std::string name, CheckpointOwner owner,
                                 const CheckpointSettings& settings, std::function<void(const std::string&)> note)
    : directory_(std::move(directory)),
      name_(std::move(name)),
      owner_(std::move(owner)),
      settings_(settings),
      note_(std::move(note)) {
    if (settings_.wanted != nullptr) wanted_ = settings_.wanted->load();
}

bool TestCheckpoints::due(bool stopped) {
    if (stopped) return true;
    if (settings_.wanted != nullptr && settings_.wanted->load(std::memory_order_relaxed) != wanted_) return true;
    return std::chrono::duration<double>(Clock::now() - kept_at_).count() >= settings_.every_s;
}

void TestCheckpoints::keep(const std::function<void(const StatePut&)>& write) {
    if (settings_.wanted != nullptr) wanted_ = settings_.wanted->load();
    try {
        write_checkpoint(directory_, name_, owner_, write);
        told_of_failure_ = false;
    } catch (const OutputError& error) {
        if (!told_of_failure_)
            tell(fmt::format("the state of this test cannot be kept, and it goes on without: {}", error.what()));
        told_of_failure_ = true;
    }
    kept_at_ = Clock::now();
}

std::vector<char> TestCheckpoints::kept() {
    Checkpoint found = read_checkpoint(directory_.path(), name_, owner_);
    if (!found.refused.empty()) refuse(found.refused);
    return std::move(found.state);
}

void TestCheckpoints::refuse(const std::string& reason) {
    const fs::path file = directory_.path() / name_;
    tell(fmt::format("the kept state '{}' is not used, and its test begins anew: {}. It stays as '{}.refused'", file.string(),
                     reason, file.filename().string()));
    std::error_code ignored;
    fs::rename(file, file.string() + ".refused", ignored);
    fs::remove(before_of(file), ignored);
}

}  // namespace feldspar
