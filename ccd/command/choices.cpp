#include "command/choices.h"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <thread>

namespace tightrope::ccd {

CLI::Option* add_kind(CLI::App& app, std::string& text, const std::string& help) {
  return app.add_option("--kind", text, help)
      ->type_name("KIND")
      ->check(CLI::IsMember({std::string(name(Kind::vertex_face)), std::string(name(Kind::edge_edge))}));
}

std::optional<Kind> chosen_kind(std::string_view text) {
  if (text == name(Kind::vertex_face)) return Kind::vertex_face;
  if (text == name(Kind::edge_edge)) return Kind::edge_edge;
  return std::nullopt;
}

CLI::Option* add_format(CLI::App& app, std::string& text, const std::vector<std::string>& accepted) {
  text = accepted.front();
  return app.add_option("--format", text, fmt::format("{}; {} if not given", fmt::join(accepted, ", "), text))
      ->type_name("FORMAT")
      ->check(CLI::IsMember(accepted));
}

std::variant<std::vector<Method>, std::string> chosen_methods(std::string_view text) {
  std::vector<Method> chosen;
  const auto add = [&](Method method) {
    if (std::find(chosen.begin(), chosen.end(), method) == chosen.end()) chosen.push_back(method);
  };
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view wanted = text.substr(0, comma);
    if (wanted == "all") {
      for (const MethodInfo& info : methods()) add(info.method);
    } else if (const auto method = method_by_name(wanted)) {
      add(*method);
    } else {
      return fmt::format("unknown method '{}'; accepted: all, {}", wanted, method_names());
    }
    if (comma == std::string_view::npos) return chosen;
    text.remove_prefix(comma + 1);
  }
}

namespace {

/// Those that this process may run on, which a launcher may have limited.
int processors() {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof(set), &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

std::string instruction_names() {
  std::string names;
  for (const InstructionSet set : instruction_sets())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name(set));
  return names;
}

}  // namespace

void add_execution(CLI::App& app, ExecutionChoice& choice) {
  constexpr int most_threads = 4096;
  app.add_option("--threads", choice.threads, "1 if not given; 0: as many as the machine has processors")
      ->type_name("N")
      ->check(CLI::Range(0, most_threads));
  app.add_option(
         "--instructions", choice.instructions,
         fmt::format("vector instructions, the best if not given: {}; the answers are the same", instruction_names()))
      ->type_name("NAME");
}

void add_device(CLI::App& app, ExecutionChoice& choice) {
  app.add_option("--device", choice.device, "cpu or gpu; cpu if not given")
      ->type_name("DEVICE")
      ->check(CLI::IsMember({"cpu", "gpu"}));
}

std::variant<Execution, std::string> chosen_execution(const ExecutionChoice& choice) {
  Execution execution = default_execution();
  if (choice.device == name(Device::gpu)) execution.device = Device::gpu;
  if (std::string why = why_unusable(execution.device); !why.empty()) {
    return fmt::format("--device {}: {}", choice.device, why);
  }
  execution.threads = choice.threads > 0 ? choice.threads : processors();
  if (choice.instructions.empty()) return execution;
  const auto wanted = instruction_set_by_name(choice.instructions);
  const auto there = instruction_sets();
  if (!wanted || std::find(there.begin(), there.end(), *wanted) == there.end()) {
    return fmt::format("instructions '{}': {}; accepted: {}", choice.instructions,
                       wanted ? "not in this build, or not on this machine" : "unknown", instruction_names());
  }
  execution.instructions = *wanted;
  return execution;
}

std::string method_names() {
  std::string names;
  for (const MethodInfo& info : methods()) names += fmt::format("{}{}", names.empty() ? "" : ", ", info.name);
  return names;
}

}  // namespace tightrope::ccd
