#include "codegen/explore/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "codegen/clang/parse.h"
#include "codegen/explore/float_first.h"
#include "codegen/explore/process.h"
#include "codegen/gappa.h"
#include "codegen/interface.h"
#include "codegen/print_cpp.h"

namespace tightrope::codegen::explore {
namespace {

namespace fs = std::filesystem;

/// Schemes in one file: large enough to share the cost of starting the compiler, small enough to fill the processors.
constexpr std::size_t schemes_in_a_file = 6;
constexpr std::size_t most_rows = 512;

/// Reads rows, times every function in turn: prints "NUMBER NANOSECONDS" a line.
constexpr std::string_view main_code = R"(
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

static double now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

int main(int, char** argv) {
  FILE* file = fopen(argv[1], "rb");
  std::vector<input> rows(static_cast<size_t>(count * stride));
  if (file == nullptr || fread(rows.data(), sizeof(input), rows.size(), file) != rows.size()) return 1;
  const int schemes = sizeof functions / sizeof *functions;
  volatile long sink = 0;
  std::vector<long> repeats;
  for (int i = 0; i < schemes; ++i) {
    long n = 1;
    for (;; n *= 2) {
      const double start = now();
      for (long r = 0; r < n; ++r) sink = sink + functions[i](rows.data(), count);
      if (now() - start > 2e5) break;
    }
    repeats.push_back(n);
  }
  for (int round = 0; round < rounds; ++round) {
    for (int i = 0; i < schemes; ++i) {
      const long n = repeats[static_cast<size_t>(i)];
      const double start = now();
      for (long r = 0; r < n; ++r) sink = sink + functions[i](rows.data(), count);
      printf("%d %.17g\n", numbers[i], (now() - start) / static_cast<double>(n * count));
    }
  }
}
)";

constexpr std::string_view counting_code = R"(#include <tightrope/sign.h>
namespace tightrope {
template <class Real>
static inline long definite(const Bounded<Real>& x) { return sign(x) != Sign::uncertain; }
template <class Element, decltype(sizeof(0)) N>
static inline long definite(const Element (&array)[N]) {
  long count = 0;
  for (const Element& element : array) count += definite(element);
  return count;
}
}  // namespace tightrope
)";

bool has_fma() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("fma");
#else
  return true;
#endif
}

/// The arguments of a call, read from the row `x` where they lie.
std::string call_arguments(const dsl::Predicate& predicate, const std::string& real) {
  std::string list;
  std::size_t offset = 0;
  for (const Argument& a : arguments(predicate)) {
    if (!list.empty()) list += ", ";
    const std::string place = fmt::format("x + {}", offset);
    const std::string pointer =
        a.bounded ? fmt::format("reinterpret_cast<const tightrope::Bounded<{}>*>({})", real, place) : place;
    list += a.pointer ? pointer : fmt::format("*({})", pointer);
    offset += a.slots.size() * (a.bounded ? 2 : 1);
  }
  return list;
}

std::size_t stride(const dsl::Predicate& predicate) {
  return arranged(predicate, Row(predicate.slots.size(), 0.0)).size();
}

}  // namespace

std::vector<double> arranged(const dsl::Predicate& predicate, const Row& row) {
  std::vector<double> result;
  for (const Argument& a : arguments(predicate)) {
    for (const int slot : a.slots) {
      result.push_back(row[static_cast<std::size_t>(slot)]);
      if (a.bounded) result.push_back(0);
    }
  }
  return result;
}

std::string find_compiler(std::string& error) {
  if (const char* named = std::getenv("CXX"); named != nullptr && *named != '\0') {
    const std::string found = find_program(named);
    if (found.empty()) error = fmt::format("$CXX is '{}', which is no program; schemes cannot be timed", named);
    return found;
  }
  for (const char* name : {"c++", "g++", "clang++"}) {
    if (const std::string found = find_program(name); !found.empty()) return found;
  }
  error = "no C++ compiler (c++, g++, clang++ or $CXX) to time schemes with; --no-time does without";
  return "";
}

std::string timed_code(const Candidate& candidate, std::size_t number, const TimingRequest& request) {
  const std::string name = fmt::format("scheme_{}", number);
  dsl::Predicate predicate = candidate.predicate;
  predicate.name = name;
  const std::string real = codegen::name(request.inputs);
  HeaderOptions options;
  options.mode = candidate.scheme.bound;
  options.precision = candidate.precision;
  std::string text = "\nTIGHTROPE_PRECISE_BEGIN\nnamespace tightrope::generated {\n";
  text += candidate.filter ? print_float_first(candidate, name, request.inputs)
                           : print_predicate({&predicate, &candidate.bounded}, options);
  text += "}  // namespace tightrope::generated\nTIGHTROPE_PRECISE_END\n";
  const std::string list = call_arguments(predicate, real);
  const bool has_range = std::any_of(predicate.parameters.begin(), predicate.parameters.end(),
                                     [](const dsl::Parameter& p) { return p.range.has_value(); });
  const std::string code = fmt::format("tightrope::generated::{}<tightrope::{}, {}>", name, tag(options.mode), real);
  const bool several = predicate.stages.size() > 1;
  text += fmt::format("\nlong {}(const {}* rows, long count) {{\n  long definite = 0;\n", name, real);
  text += fmt::format(
      "  for (long i = 0; i < count; ++i) {{\n    const {}* x = rows + i * {};\n"
      // One call after the other: the loop is not to be vectorised.
      "    __asm__ volatile(\"\" : : : \"memory\");\n",
      real, stride(predicate));
  if (several) text += fmt::format("    {}::State state;\n", code);
  for (std::size_t s = 0; s <= request.last_stage; ++s) {
    const dsl::Stage& stage = predicate.stages[s];
    text += fmt::format("    const auto result_{} = {}::{}{}({}{});\n", s, code, stage.name,
                        has_range ? "_in_range" : "", list, several ? ", state" : "");
    for (const dsl::Output& output : stage.outputs) {
      text += fmt::format("    definite += tightrope::definite(result_{}.{});\n", s, output.name);
    }
  }
  return text + "  }\n  return definite;\n}\n";
}

namespace {

/// What goes into one object file: candidates that are compiled with the same flags.
struct Unit {
  bool fma = false;
  std::vector<std::size_t> numbers;
};

std::vector<Unit> units(std::span<const Candidate* const> candidates) {
  std::vector<Unit> result;
  for (const bool fma : {false, true}) {
    if (fma && !has_fma()) continue;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (candidates[i]->scheme.fma != fma) continue;
      if (result.empty() || result.back().fma != fma || result.back().numbers.size() == schemes_in_a_file) {
        result.push_back({fma, {}});
      }
      result.back().numbers.push_back(i);
    }
  }
  return result;
}

void write_rows(const fs::path& path, const dsl::Predicate& predicate, std::span<const Row> rows, Precision inputs) {
  std::ofstream stream(path, std::ios::binary);
  for (const Row& row : rows) {
    for (const double x : arranged(predicate, row)) {
      const auto single = static_cast<float>(x);
      const bool is_double = inputs == Precision::binary64;
      stream.write(is_double ? reinterpret_cast<const char*>(&x) : reinterpret_cast<const char*>(&single),
                   is_double ? sizeof x : sizeof single);
    }
  }
}

std::string main_text(const std::vector<Unit>& all, const dsl::Predicate& predicate, std::size_t rows,
                      const TimingRequest& request) {
  std::string text =
      fmt::format("typedef {} input;\nconst long count = {};\nconst long stride = {};\nconst int rounds = {};\n",
                  name(request.inputs), rows, stride(predicate), request.rounds);
  std::string functions;
  std::string numbers;
  for (const Unit& unit : all) {
    for (const std::size_t number : unit.numbers) {
      text += fmt::format("long scheme_{}(const input* rows, long count);\n", number);
      functions += fmt::format("scheme_{}, ", number);
      numbers += fmt::format("{}, ", number);
    }
  }
  return text +
         fmt::format("long (*const functions[])(const input*, long) = {{{}}};\nconst int numbers[] = {{{}}};\n",
                     functions, numbers) +
         std::string(main_code);
}

Command compilation(const fs::path& folder, const std::string& source, const TimingRequest& request, bool fma) {
  Command command{{request.compiler, "-std=c++20"}, folder / (source + ".log")};
  command.words.insert(command.words.end(), request.flags.begin(), request.flags.end());
#if defined(__x86_64__) || defined(__i386__)
  if (fma) command.words.push_back("-mfma");
#endif
  command.words.insert(command.words.end(), {"-I" + folder.string(), "-c", (folder / source).string(), "-o",
                                             (folder / (source + ".o")).string()});
  return command;
}

std::string first_lines(const std::string& text) {
  std::size_t end = 0;
  for (int i = 0; i < 5 && end != std::string::npos; ++i) end = text.find('\n', end + (i == 0 ? 0 : 1));
  return text.substr(0, end);
}

std::vector<Time> parsed_times(const std::string& output, std::size_t count) {
  std::vector<std::vector<double>> rounds(count);
  std::stringstream stream(output);
  std::size_t number = 0;
  double nanoseconds = 0;
  while (stream >> number >> nanoseconds && number < count) rounds[number].push_back(nanoseconds);
  std::vector<Time> times(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double>& own = rounds[i];
    if (own.empty()) continue;
    std::sort(own.begin(), own.end());
    times[i] = {own[own.size() / 2], own[own.size() / 4], own[own.size() - 1 - own.size() / 4]};
  }
  return times;
}

}  // namespace

std::string measure_times(std::span<const Candidate* const> candidates, const std::vector<Row>& all_rows,
                          const TimingRequest& request, std::vector<Time>& times) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, std::string_view text) {
    fs::create_directories((folder.path() / name).parent_path());
    std::ofstream(folder.path() / name, std::ios::binary) << text;
  };
  for (const EmbeddedHeader& header : runtime_headers()) write(std::string(header.name), header.text);
  const std::span<const Row> rows = std::span(all_rows).first(std::min(all_rows.size(), most_rows));
  const dsl::Predicate& predicate = candidates.front()->predicate;
  write_rows(folder.path() / "rows", predicate, rows, request.inputs);
  const std::vector<Unit> all = units(candidates);
  std::vector<Command> commands;
  Command link{{request.compiler}, folder.path() / "link.log"};
  const auto compile = [&](const std::string& source, const std::string& text, bool fma) {
    write(source, text);
    commands.push_back(compilation(folder.path(), source, request, fma));
    link.words.push_back((folder.path() / (source + ".o")).string());
  };
  for (std::size_t u = 0; u < all.size(); ++u) {
    std::string text(counting_code);
    for (const std::size_t number : all[u].numbers) text += timed_code(*candidates[number], number, request);
    compile(fmt::format("schemes_{}.cpp", u), text, all[u].fma);
  }
  compile("main.cpp", main_text(all, predicate, rows.size(), request), false);
  if (const int failed = run_all(commands); failed >= 0) {
    return fmt::format("{} cannot compile the schemes:\n{}", request.compiler,
                       first_lines(file_text(commands[static_cast<std::size_t>(failed)].log)));
  }
  const std::string program = (folder.path() / "times").string();
  link.words.insert(link.words.end(), {"-o", program});
  if (run_all({link}) >= 0) {
    return fmt::format("{} cannot link the schemes:\n{}", request.compiler, first_lines(file_text(link.log)));
  }
  const fs::path output = folder.path() / "times.log";
  if (run_all({{{program, (folder.path() / "rows").string()}, output}}) >= 0) return "the timed schemes do not run";
  times = parsed_times(file_text(output), candidates.size());
  return "";
}

}  // namespace tightrope::codegen::explore
