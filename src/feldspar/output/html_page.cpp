#include "feldspar/output/html_page.hpp"

#include "feldspar/base/printable.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/report_assets.hpp"

namespace feldspar {

std::string escaped(const std::string& text) {
    std::string html;
    for (const char letter : printable(text)) {
        switch (letter) {
            case '&':
                html += "&amp;";
                break;
            case '<':
                html += "&lt;";
                break;
            case '>':
                html += "&gt;";
                break;
            case '"':
                html += "&quot;";
                break;
            case '\'':
                html += "&#39;";
                break;
            default:
                html += letter;
        }
    }
    return html;
}

namespace {

nlohmann::ordered_json printable_json(const nlohmann::ordered_json& json) {
    if (json.is_string()) return printable(json.get_ref<const std::string&>());
    nlohmann::ordered_json shown = json;
    if (json.is_array())
        for (auto& value : shown) value = printable_json(value);
    if (json.is_object()) {
        shown = nlohmann::ordered_json::object();
        for (const auto& [key, value] : json.items()) shown[printable(key)] = printable_json(value);
    }
    return shown;
}

}  // namespace

std::string script_json(const nlohmann::ordered_json& json) {
    const std::string text = printable_json(json).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (const char letter : text) {
        if (letter == '<')
            safe += "\\u003c";
        else
            safe += letter;
    }
    return safe;
}

void HtmlPage::fill(const std::string& mark, const std::string& text) {
    const std::string wanted = "{{" + mark + "}}";
    const std::size_t found = page_.find(wanted, from_);
    if (found == std::string::npos) return;
    page_.replace(found, wanted.size(), text);
    from_ = found + text.size();
}

nlohmann::ordered_json with_methods(nlohmann::ordered_json data) {
    for (const MethodId id : test_methods()) {
        const TestMethod& method = method_of(id);
        data["methods"][method.name] = {{"title", method.words.title},          {"sign", method.loading.sign},
                                        {"strength", method.strength.name},     {"on_envelope", method.loading.on_envelope},
                                        {"confined", method.specimen.confined}, {"pressure", pressure_symbol(method)}};
    }
    return data;
}

std::string html_page(const std::string& title, const nlohmann::ordered_json& data, const char* script) {
    HtmlPage page(asset_page_html);
    page.fill("title", escaped(title));
    page.fill("uplot_css", asset_uPlot_min_css);
    page.fill("css", asset_report_css);
    page.fill("data", script_json(with_methods(data)));
    page.fill("uplot_js", asset_uPlot_iife_min_js);
    page.fill("charts_js", asset_charts_js);
    page.fill("page_js", asset_page_js);
    page.fill("script", script);
    return page.text();
}

}  // namespace feldspar
