#include "fit/choice.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

namespace tightrope::ccd {
namespace {

constexpr std::size_t numbers_per_query = 24;

/// Decides `count` queries of the sample from `first` on.
using Pass = std::function<void(std::size_t first, std::size_t count)>;

/// Nanoseconds of each pass over `count` queries: the sum of each block's median. The passes take turns at every block,
/// so that a change of the machine's speed meets all.
std::vector<double> medians(const std::vector<Pass>& passes, std::size_t count) {
  using Clock = std::chrono::steady_clock;
  constexpr double time_of_all = 2e9;
  constexpr int least_rounds = 5;
  constexpr int most_rounds = 201;
  const auto begin = Clock::now();
  const std::size_t few = std::min<std::size_t>(count, 256);
  passes.front()(0, few);
  const double slow = std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / static_cast<double>(few);
  // Passes of a tenth of a millisecond or less: few of them are interrupted by whatever else the machine does.
  const auto block = static_cast<std::size_t>(std::clamp(1e5 / slow, 16.0, 2048.0));
  const std::size_t blocks = (count + block - 1) / block;
  std::vector<std::vector<double>> times(passes.size() * blocks);
  for (int round = 0; round < most_rounds; ++round) {
    const double spent = std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
    if (round >= least_rounds && spent > time_of_all) break;
    for (std::size_t b = 0; b < blocks; ++b) {
      for (std::size_t i = 0; i < passes.size(); ++i) {
        const auto start = Clock::now();
        passes[i](b * block, std::min(block, count - b * block));
        times[i * blocks + b].push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
      }
    }
  }
  std::vector<double> result(passes.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto middle = times[i].begin() + static_cast<std::ptrdiff_t>(times[i].size() / 2);
    std::nth_element(times[i].begin(), middle, times[i].end());
    result[i / blocks] += *middle;
  }
  return result;
}

/// The sample in the forms that the looks take: with coordinates up to 1, of type float.
struct Forms {
  explicit Forms(const SceneSample& sample);

  Kind kind;
  std::size_t count;
  std::optional<int> exponent;        ///< of the range in double precision
  std::optional<int> float_exponent;  ///< and in single precision
  bool floats;                        ///< all coordinates are of type float
  std::vector<double> points;
  std::vector<double> unit_points;
  std::vector<float> float_points;
  std::vector<float> unit_float_points;
  std::vector<unsigned char> results;
};

Forms::Forms(const SceneSample& sample)
    : kind(sample.kind()),
      count(sample.points().size() / numbers_per_query),
      exponent(range_exponent(sample.figures().largest, false)),
      float_exponent(range_exponent(sample.figures().largest, true)),
      floats(sample.figures().floats == sample.figures().queries),
      points(sample.points().begin(), sample.points().end()),
      results(count) {
  for (const double x : points) {
    if (exponent) unit_points.push_back(std::ldexp(x, -*exponent));
    if (floats) float_points.push_back(static_cast<float>(x));
    if (floats && float_exponent) unit_float_points.push_back(static_cast<float>(std::ldexp(x, -*float_exponent)));
  }
}

/// All looks that can be taken at the scene.
std::vector<Look> candidates(const Forms& forms, const SceneFigures& figures) {
  std::vector<Look> looks;
  for (const bool single : {false, true}) {
    if (single && !forms.floats) continue;
    for (const bool range : {false, true}) {
      if (range && !(single ? forms.float_exponent : forms.exponent)) continue;
      for (const bool at_rest : {false, true}) {
        const auto resting = forms.kind == Kind::vertex_face ? figures.second_at_rest : figures.either_at_rest;
        if (at_rest && resting == 0) continue;
        for (const bool both_ends : {false, true}) looks.push_back({single, range, at_rest, both_ends});
      }
    }
  }
  return looks;
}

/// Decides queries by the look, with the full model behind it or alone.
void run(Forms& forms, const Look& look, bool alone, std::size_t first, std::size_t count) {
  const std::size_t offset = numbers_per_query * first;
  unsigned char* results = &forms.results[first];
  if (look.single) {
    const auto decide = alone ? unit_open<float>(forms.kind, look) : unit_contacts<float>(forms.kind, look);
    decide(&(look.range ? forms.unit_float_points : forms.float_points)[offset], count, results);
  } else {
    const auto decide = alone ? unit_open<double>(forms.kind, look) : unit_contacts<double>(forms.kind, look);
    decide(&(look.range ? forms.unit_points : forms.points)[offset], count, results);
  }
}

/// Of the looks that are about as fast as the fastest, the simplest.
const LookMeasurement& best_look(const std::vector<LookMeasurement>& looks) {
  constexpr double about = 1.03;
  const auto faster = [](const auto& a, const auto& b) { return a.nanoseconds < b.nanoseconds; };
  const double fastest = std::min_element(looks.begin(), looks.end(), faster)->nanoseconds;
  const auto simpler = [&](const LookMeasurement& a, const LookMeasurement& b) {
    const bool a_fast = a.nanoseconds <= about * fastest;
    const bool b_fast = b.nanoseconds <= about * fastest;
    if (a_fast != b_fast) return a_fast;
    return complexity(a.look) != complexity(b.look) ? complexity(a.look) < complexity(b.look)
                                                    : a.nanoseconds < b.nanoseconds;
  };
  return *std::min_element(looks.begin(), looks.end(), simpler);
}

void measure_looks(Choice& choice, Forms& forms, const SceneFigures& figures) {
  const double count = static_cast<double>(forms.count);
  std::vector<Pass> passes{[&](std::size_t first, std::size_t n) {
    collides(forms.kind, &forms.points[numbers_per_query * first], n, &forms.results[first], Method::tightrope);
  }};
  for (const Look& look : candidates(forms, figures)) {
    run(forms, look, true, 0, forms.count);
    const auto open = std::count(forms.results.begin(), forms.results.end(), 1);
    choice.looks.push_back({.look = look, .open = static_cast<double>(open) / count});
    passes.emplace_back([&forms, look](std::size_t first, std::size_t n) { run(forms, look, false, first, n); });
  }
  const std::vector<double> times = medians(passes, forms.count);
  choice.full_nanoseconds = times[0] / count;
  for (std::size_t i = 0; i < choice.looks.size(); ++i) choice.looks[i].nanoseconds = times[i + 1] / count;
}

/// The method for what the look leaves open: exact, or the fastest of those with few enough false positives.
void choose_method(Choice& choice, Forms& forms, const FitRequest& request) {
  run(forms, choice.look, true, 0, forms.count);
  std::vector<double> open;
  for (std::size_t i = 0; i < forms.count; ++i) {
    const auto query = forms.points.begin() + static_cast<std::ptrdiff_t>(numbers_per_query * i);
    if (forms.results[i] != 0) open.insert(open.end(), query, query + numbers_per_query);
  }
  const std::size_t count = open.size() / numbers_per_query;
  if (count == 0) return;
  std::vector<unsigned char> truths(count);
  collides(choice.kind, open.data(), count, truths.data(), Method::tightrope);
  const auto contacts = static_cast<std::size_t>(std::count(truths.begin(), truths.end(), 1));
  const double without_contact = static_cast<double>(forms.count - contacts);
  std::vector<Pass> passes;
  std::vector<unsigned char> answers(count);
  for (const MethodInfo& info : methods()) {
    if (!info.conservative || (info.exact && info.method != Method::tightrope)) continue;
    collides(choice.kind, open.data(), count, answers.data(), info.method);
    std::size_t false_positives = 0;
    for (std::size_t i = 0; i < count; ++i) false_positives += answers[i] > truths[i] ? 1 : 0;
    const double rate = without_contact > 0 ? static_cast<double>(false_positives) / without_contact : 0;
    choice.methods.push_back({.method = info.method, .false_positives = rate});
    passes.emplace_back([&, method = info.method](std::size_t first, std::size_t n) {
      collides(choice.kind, &open[numbers_per_query * first], n, &answers[first], method);
    });
  }
  const std::vector<double> times = medians(passes, count);
  const MethodMeasurement* best = nullptr;
  for (std::size_t i = 0; i < times.size(); ++i) {
    MethodMeasurement& m = choice.methods[i];
    m.nanoseconds = times[i] / static_cast<double>(count);
    const bool allowed = m.method == Method::tightrope || m.false_positives <= request.max_false_positives;
    if (allowed && (best == nullptr || m.nanoseconds < best->nanoseconds)) best = &m;
  }
  const auto exact = std::find_if(choice.methods.begin(), choice.methods.end(),
                                  [](const auto& m) { return m.method == Method::tightrope; });
  choice.method = best->method;
  choice.false_positives = best->false_positives;
  const double share = static_cast<double>(count) / static_cast<double>(forms.count);
  choice.nanoseconds = std::max(0.0, choice.nanoseconds + share * (best->nanoseconds - exact->nanoseconds));
}

}  // namespace

Choice choose(const SceneSample& sample, const FitRequest& request) {
  Forms forms(sample);
  Choice choice{.kind = sample.kind()};
  measure_looks(choice, forms, sample.figures());
  const LookMeasurement& best = best_look(choice.looks);
  choice.look = best.look;
  choice.nanoseconds = best.nanoseconds;
  if (best.look.range) choice.exponent = best.look.single ? forms.float_exponent : forms.exponent;
  if (request.max_false_positives > 0 && !request.times) choose_method(choice, forms, request);
  return choice;
}

}  // namespace tightrope::ccd
