#include "printing.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace feldspar {

void Printing::print_object(const Json& object) {
    put(stdout, object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    std::fflush(stdout);
    printed_ = true;
}

void Printing::end(const std::filesystem::path& directory, const std::function<Json()>& object) {
    if (options_.json)
        print_object(object());
    else if (options_.quiet)
        say("{}\n", directory.string());
    std::fflush(stdout);
}

ExitCode printing(const PrintOptions& options, const std::function<ExitCode(Printing&)>& command) {
    Printing print(options);
    if (!options.json) return command(print);
    const auto tell = [&](const char* kind, const std::exception& error, const InputPlace* place) {
        if (print.object_printed()) return;
        Json words = {{"kind", kind}, {"message", error.what()}};
        if (place != nullptr) {
            words["file"] = place->file;
            words["line"] = place->line;
            words["column"] = place->column;
            words["key"] = place->key;
        }
        print.print_object({{"error", std::move(words)}});
    };
    try {
        return command(print);
    } catch (const InputError& error) {  // what programs that call this one want to show their users
        tell("input", error, &error.place());
        throw;
    } catch (const OutputError& error) {
        tell("output", error, nullptr);
        throw;
    } catch (const Interrupted& error) {
        tell("interrupted", error, nullptr);
        throw;
    } catch (const std::exception& error) {
        tell("numerical", error, nullptr);
        throw;
    }
}

Json with_file(Json object, const std::filesystem::path& file) {
    std::ifstream in(file);
    const Json inside = Json::parse(in, nullptr, false);
    if (!inside.is_object()) throw OutputError(fmt::format("'{}' cannot be read again", file.string()));
    for (const auto& [key, value] : inside.items()) object[key] = value;
    return object;
}

}  // namespace feldspar
