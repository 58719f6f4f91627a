// The report's page, styles and scripts, compiled in from assets/ and vendor/ by embed.cmake.
#pragma once

namespace feldspar {

extern const char* const asset_report_html;  ///< the page, with marks such as {{data}}
extern const char* const asset_report_css;
extern const char* const asset_page_html;       ///< the same for the pages of html_page()
extern const char* const asset_charts_js;       ///< line charts over uPlot
extern const char* const asset_page_js;         ///< theme, tables, pickers: what every page stands on
extern const char* const asset_viewer_js;       ///< failure pattern and crack rosette
extern const char* const asset_compare_js;      ///< variants side by side
extern const char* const asset_report_js;       ///< tables and the page as a whole
extern const char* const asset_envelope_js;     ///< strength envelopes (findings/envelope_files.cpp)
extern const char* const asset_converge_js;     ///< convergence (findings/converge_files.cpp)
extern const char* const asset_study_js;        ///< points of a study (study/study_report.cpp)
extern const char* const asset_calibration_js;  ///< calibration (calibration/calibration_report.cpp)
extern const char* const asset_verify_js;       ///< closed forms (verify/write_checks.cpp)
extern const char* const asset_paraview_py;     ///< by which ParaView shows a test, with marks such as {{stem}}
extern const char* const asset_live_js;         ///< what is going on in a run, above its report (live/live_page.cpp)
extern const char* const asset_live_css;
extern const char* const asset_uPlot_iife_min_js;
extern const char* const asset_uPlot_min_css;

}  // namespace feldspar
