// Specimens, each made once and shared by the runs on it.
#pragma once

#include <atomic>
#include <deque>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "feldspar/specimen/specimen.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

/// Keeps the specimens used last. Any thread may ask; who asks first makes it, and others wait.
class Packings {
public:
    /// @param kept  so many specimens stay when nobody uses them
    Packings(std::size_t kept, const std::atomic<bool>* stop) : kept_(kept), stop_(stop) {}

    /// The run's specimen. @throws what making it throws; Interrupted
    std::shared_ptr<const Specimen> get(const Run& run, int threads);

private:
    using Made = std::shared_future<std::shared_ptr<const Specimen>>;

    std::size_t kept_;
    const std::atomic<bool>* stop_;
    std::mutex mutex_;
    std::map<std::string, Made> made_;
    std::deque<std::string> used_;   // keys, the latest at the end
};

}  // namespace feldspar
