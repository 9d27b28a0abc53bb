// report_page.cpp: fills tools/report/page.html with a run's data. See report_page.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

#include "core/results_layout.h"
#include "tools/report_scene.h"

namespace scree {

extern char const report_page_text[];  // tools/report/page.html

std::string json_string(std::string const& text) {
  std::string out = "\"";
  for (char const c : text) {
    auto const code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      (out += '\\') += c;
    else if (c == '\n')
      out += "\\n";
    else if (code < 0x20 || c == '<')  // "</script>" would end the element
      out += fmt::format("\\u{:04x}", code);
    else
      out += c;
  }
  return out + '"';
}

std::string base64(void const* data, std::size_t bytes) {
  char constexpr digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  auto const* const from = static_cast<unsigned char const*>(data);
  std::string out;
  out.reserve((bytes + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes; i += 3) {
    unsigned const rest = static_cast<unsigned>(std::min<std::size_t>(3, bytes - i));
    unsigned word = from[i] << 16;
    if (rest > 1) word |= from[i + 1] << 8;
    if (rest > 2) word |= from[i + 2];
    for (unsigned k = 0; k < 4; ++k) out += k <= rest ? digit[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::vector<std::size_t> thinned(std::size_t n, std::size_t most) {
  std::vector<std::size_t> out;
  std::size_t const count = std::min(n, most);
  for (std::size_t i = 0; i < count; ++i) out.push_back(count < 2 ? 0 : i * (n - 1) / (count - 1));
  return out;
}

namespace {

// JSON has no NaN and no infinity.
std::string json_number(double v) { return std::isfinite(v) ? fmt::format("{:.6g}", v) : "null"; }

template <class Range, class Text>
std::string json_list(Range const& range, Text const& text) {
  std::string out;
  for (auto const& item : range) (out += out.empty() ? "" : ",") += text(item);
  return "[" + out + "]";
}

char const* words_of(std::string const& column) {
  static std::map<std::string, char const*> const words = {{"elastic_normal", "elastic, normal"},
                                                           {"elastic_tangential", "elastic, tangential"},
                                                           {"elastic_rolling", "elastic, rolling"},
                                                           {"inserted", "brought in by insertion"},
                                                           {"wall_work", "work of walls"},
                                                           {"applied", "work of applied forces"},
                                                           {"damping", "lost to contact damping"},
                                                           {"friction", "lost to friction"},
                                                           {"rolling", "lost to rolling resistance"},
                                                           {"global_damping", "lost to global damping"},
                                                           {"drag", "lost to drag"},
                                                           {"deleted", "of deleted bodies"},
                                                           {"removed", "removed by the program"},
                                                           {"residual", "not accounted for"},
                                                           {"moved", "energy moved"}};
  auto const at = words.find(column);
  return at == words.end() ? nullptr : at->second;
}

std::string ledger_json(ResultsReader const& results) {
  auto const rows = results.ledger();
  auto const columns = results_layout::columns_with(results.header().ledger);
  std::string words;
  for (auto const& c : columns)
    if (char const* w = words_of(c.name))
      words += fmt::format("{}{}:{}", words.empty() ? "" : ",", json_string(c.name), json_string(w));
  return fmt::format("{{\"columns\":{},\"words\":{{{}}},\"rows\":{}}}",
                     json_list(columns, [](auto const& c) { return json_string(c.name); }), words,
                     json_list(thinned(rows.size(), 400), [&](std::size_t i) {
                       return json_list(columns, [&](auto const& c) { return json_number(rows[i].*c.value); });
                     }));
}

// One series for each "name.quantity" of the CSV, with the unit of its summary.
std::string series_json(std::string const& csv, std::vector<MeasureSummary> const& summaries) {
  std::map<std::string, std::vector<std::pair<double, double>>> series;
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);  // header
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string time, name, quantity, value;
    if (!(std::getline(fields, time, ',') && std::getline(fields, name, ',') && std::getline(fields, quantity, ',') &&
          std::getline(fields, value)))
      continue;
    series[name + "." + quantity].push_back({std::atof(time.c_str()), std::atof(value.c_str())});
  }
  std::string out;
  for (auto const& [name, points] : series) {
    if (points.size() < 2) continue;
    std::string unit;
    for (MeasureSummary const& m : summaries)
      if (m.name == name) unit = m.unit;
    auto const shown = thinned(points.size(), 600);
    out += fmt::format("{}{{\"name\":{},\"unit\":{},\"t\":{},\"v\":{}}}", out.empty() ? "" : ",", json_string(name),
                       json_string(unit), json_list(shown, [&](std::size_t i) { return json_number(points[i].first); }),
                       json_list(shown, [&](std::size_t i) { return json_number(points[i].second); }));
  }
  return "[" + out + "]";
}

std::string facts_json(ResultsReader const& results) {
  ResultsHeader const& h = results.header();
  Frame const last = results.frame(-1);
  auto const [small, large] = std::minmax_element(h.diameter.begin(), h.diameter.end());
  std::size_t active = 0;
  for (std::size_t i = 0; i < h.shape.size(); ++i) active += last.is_active(i);
  std::vector<std::pair<std::string, std::string>> facts = {
      {"grains", fmt::format("{}, {} of them in the last frame", h.shape.size(), active)},
      {"shapes", std::to_string(h.shape_name.size())},
      {"simulated time", fmt::format("{:.6g} s in {} steps", last.time, last.step)},
      {"frames", std::to_string(results.frames())}};
  if (!h.diameter.empty())
    facts.insert(facts.begin() + 2, {"diameters", fmt::format("{:.4g} to {:.4g} m", *small, *large)});
  return json_list(facts, [](auto const& f) { return "[" + json_string(f.first) + "," + json_string(f.second) + "]"; });
}

std::string data_json(ReportPage const& page) {
  ResultsReader const& r = *page.results;
  auto const measures = r.measures();
  return fmt::format(
      "{{\"name\":{},\"subtitle\":{},\"facts\":{},\"case\":{},\"ledger\":{},\"measures\":{},\"series\":{},\"stages\":{}"
      ","
      "\"scene\":{}}}",
      json_string(page.title), json_string(fmt::format("A run of Scree, {} grains.", r.header().shape.size())),
      facts_json(r), json_string(r.header().case_text), ledger_json(r),
      json_list(measures,
                [](MeasureSummary const& m) {
                  return fmt::format("{{\"name\":{},\"unit\":{},\"value\":{},\"spread\":{},\"samples\":{}}}",
                                     json_string(m.name), json_string(m.unit), json_number(m.value()),
                                     json_number(m.spread), m.samples);
                }),
      series_json(page.measures_csv, measures),
      json_list(r.stages(),
                [](StageRow const& s) {
                  return fmt::format("[{},{},{},{}]", json_string(s.name), json_number(s.seconds), s.calls, s.items);
                }),
      scene_json(r.header(), r.frame(-1), page.threads));
}

void replace(std::string& text, std::string const& word, std::string const& by) {
  std::size_t const at = text.find(word);
  if (at != std::string::npos) text.replace(at, word.size(), by);
}

}  // namespace

std::string report_page(ReportPage const& page) {
  std::string html = report_page_text;
  std::string title;  // as HTML text
  for (char const c : page.title) title += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  std::vector<std::uint8_t> const png = png_bytes(page.picture);
  replace(html, "@TITLE@", title);
  replace(html, "@PICTURE@", base64(png.data(), png.size()));
  replace(html, "@RUN@", page.run_json.empty() ? "null" : page.run_json);
  replace(html, "@DATA@", data_json(page));
  return html;
}

}  // namespace scree
