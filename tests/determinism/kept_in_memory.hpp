// What a test leaves, as bytes; and a keeper of states in memory, which ends the test at chosen moments.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "feldspar/lab/keep_test.hpp"

namespace feldspar {

// All that a test leaves but its times, as the bytes that are kept of it.
inline std::string bytes_of(TestResult result) {
    result.wall_s = result.ms_per_step = 0.0;
    result.threads = 1;
    std::string bytes;
    const StateBase nothing;
    StateWriter writer([&](const void* data, std::size_t count) { bytes.append(static_cast<const char*>(data), count); },
                       nothing);
    keep_course(writer, result);
    return bytes;
}

// Keeps states in memory, and ends the test at chosen moments.
class Memory final : public StateKeeper {
public:
    bool due(bool stopped) override {
        ++asked_;
        if (asked_ == end_at_) stop = true;
        return stopped || asked_ % 7 == 0;  // states kept on the way do not matter
    }
    void keep(const std::function<void(const StatePut&)>& write) override {
        state.clear();
        write([&](const void* data, std::size_t count) {
            state.insert(state.end(), static_cast<const char*>(data), static_cast<const char*>(data) + count);
        });
    }
    std::vector<char> kept() override { return state; }
    void refuse(const std::string& why) override {
        refused.push_back(why);
        state.clear();
    }

    // @param moment  number of the record at which the test ends; 0: it runs on
    void end_at(int moment) {
        asked_ = 0;
        end_at_ = moment;
        stop = false;
    }

    std::vector<char> state;
    std::vector<std::string> refused;
    std::atomic<bool> stop{false};

private:
    int asked_ = 0, end_at_ = 0;
};

}  // namespace feldspar
