// A page as one file, with its data, styles and scripts inside: it opens from disk and asks the network for nothing.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace feldspar {

/// Text as it may stand between tags or in an attribute; control characters as escapes that can be read.
std::string escaped(const std::string& text);

/// JSON that may stand inside a script element: a '<' can only be in a string there, and as \u003c it ends no element. Control
/// characters in its texts are escapes that can be read.
std::string script_json(const nlohmann::ordered_json& json);

/// Replaces each {{mark}} of the page once, in the order of the page, so that nothing inserted is searched for marks.
class HtmlPage {
public:
    explicit HtmlPage(std::string page) : page_(std::move(page)) {}
    void fill(const std::string& mark, const std::string& text);
    const std::string& text() const { return page_; }

private:
    std::string page_;
    std::size_t from_ = 0;
};

/// A page of tables and charts: `script` (from report_assets.hpp) lays out `data`.
std::string html_page(const std::string& title, const nlohmann::ordered_json& data, const char* script);

/// The data of a page with `methods`: what pages have to know of each test method.
nlohmann::ordered_json with_methods(nlohmann::ordered_json data);

}  // namespace feldspar
