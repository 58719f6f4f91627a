// Prints a dictionary for the fuzzer: every key, table and word that a job may have, and some that other files have.
#include <cstdio>
#include <set>
#include <string>

#include "feldspar/job/keys.hpp"

int main() {
    using namespace feldspar;
    std::set<std::string> words{
        "[[", "]]",     "[",     "]",       "{ ", " }", " = ", "\"\"\"", "true", "1e999", "-0", "nan", "0x7fffffffffffffff",
        "%",  " GPa/m", "m^0.5", "sqrt(m)", "../"};
    for (const KeyTable& table : job_tables()) {
        words.insert(std::string(table.path));
        for (const JobKey& key : table.keys) {
            words.insert(std::string(key.name));
            for (const std::string& word : key.value.element.words) words.insert(word);
        }
    }
    for (const std::string& word : words) {
        std::string text;
        for (const char c : word) text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
        if (!text.empty()) std::printf("\"%s\"\n", text.c_str());
    }
}
