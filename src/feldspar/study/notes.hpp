// What runs have to say on threads of their own, for the main thread, which alone prints.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace feldspar {

class Notes {
public:
    /// On any thread.
    void add(std::string line) {
        const std::lock_guard lock(mutex_);
        lines_.push_back(std::move(line));
    }
    /// All since the last call, in order.
    std::vector<std::string> take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(lines_, {});
    }

private:
    std::mutex mutex_;
    std::vector<std::string> lines_;
};

}  // namespace feldspar
