// A block of numbers for the report's scripts: parts one behind the other, then zlib and base64. Internal to this room.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace feldspar {

/// Collects the parts of a block and where they lie: little-endian, each starting at a multiple of 8.
class Block {
public:
    template <class Number>
    void add(const std::string& name, const char* type, const std::vector<Number>& values) {
        bytes_.resize((bytes_.size() + 7) / 8 * 8);
        parts_[name] = {{"type", type}, {"at", bytes_.size()}, {"count", values.size()}};
        const std::size_t at = bytes_.size();
        bytes_.resize(at + values.size() * sizeof(Number));
        if (!values.empty()) std::memcpy(bytes_.data() + at, values.data(), values.size() * sizeof(Number));
    }
    const nlohmann::ordered_json& parts() const { return parts_; }

    /// The bytes compressed, as base64. @throws OutputError
    std::string packed() const;

private:
    std::vector<std::uint8_t> bytes_;
    nlohmann::ordered_json parts_ = nlohmann::ordered_json::object();
};

}  // namespace feldspar
