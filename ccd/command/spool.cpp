#include "command/spool.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "command/command.h"

namespace tightrope::ccd {
namespace {

constexpr std::size_t most_in_memory = std::size_t{1} << 20;

std::string folder() {
  const char* chosen = std::getenv("TMPDIR");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return chosen != nullptr && *chosen != '\0' ? chosen : "/tmp";
}

std::string failed() { return fmt::format("temporary file in {}: {}", folder(), std::strerror(errno)); }

/// Without a name as soon as it is open, so that nothing is left behind however the process ends.
std::FILE* unnamed_file() {
  std::string name = folder() + "/tightrope-ccd.XXXXXX";
  const int descriptor = ::mkstemp(name.data());
  if (descriptor < 0) return nullptr;
  ::unlink(name.c_str());
  std::FILE* file = ::fdopen(descriptor, "w+b");
  if (file == nullptr) ::close(descriptor);
  return file;
}

}  // namespace

std::string Spool::append(std::string_view text) {
  text_ += text;
  return text_.size() > most_in_memory ? write_out() : std::string();
}

std::string Spool::write_out() {
  if (!file_) file_.reset(unnamed_file());
  if (!file_ || std::fwrite(text_.data(), 1, text_.size(), file_.get()) != text_.size()) return failed();
  text_.clear();
  return {};
}

int Spool::print() {
  if (!file_) return ccd::print(text_);
  if (const std::string wrong = write_out(); !wrong.empty()) return fail(wrong);
  if (std::fflush(file_.get()) != 0 || std::fseek(file_.get(), 0, SEEK_SET) != 0) return fail(failed());
  std::string part(most_in_memory, '\0');
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), file_.get())) {
    if (const int status = ccd::print(std::string_view(part).substr(0, count)); status != success) return status;
  }
  return std::ferror(file_.get()) != 0 ? fail(failed()) : success;
}

}  // namespace tightrope::ccd
