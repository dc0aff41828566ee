#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "virtual_work_dynamics/generated_code.h"
#include "virtual_work_dynamics/instruction_set.h"

namespace virtual_work_dynamics {

/// Options under which nothing is to be warned of.
constexpr char kStrictC[] = "-std=c99 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror ";
constexpr char kStrictCpp[] =
    "-x c++ -std=c++17 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror ";

/// As for a machine without an operating system, and all that both compilers warn of.
constexpr char kStrictest[] =
    "-std=c99 -pedantic-errors -ffreestanding -Wall -Wextra -Wshadow -Wconversion "
    "-Wsign-conversion -Wdouble-promotion -Wfloat-conversion -Wundef -Wvla -Wcast-qual "
    "-Wcast-align -Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition "
    "-Wredundant-decls -Wswitch-default -Wformat=2 -Werror ";

/// The instructions that a generated program is compiled for, and the library's that it is compared
/// with.
inline InstructionSet comparedInstructions() {
  return isSupported(InstructionSet::kAvx2) ? InstructionSet::kAvx2 : InstructionSet::kBaseline;
}
inline std::string optionsFor(InstructionSet set) {
  return set == InstructionSet::kBaseline ? "" : "-mavx2 -mfma ";
}

/// Whether a compiler can be called.
inline bool isThere(const std::string& compiler) {
  return std::system(("command -v " + compiler + " >/dev/null 2>&1").c_str()) == 0;
}

/// Generated code that is compiled with a main function in a folder of its own.
class GeneratedProgram {
 public:
  /// @param inputs, outputs numbers of a sample of each array, in the function's order
  /// @param judged whether the functions tell a status, which becomes the last of the outputs
  GeneratedProgram(const GeneratedCode& code, const std::string& name,
                   const std::vector<int>& inputs, const std::vector<int>& outputs,
                   bool judged = false)
      : name_(name), inputs_(inputs), outputs_(outputs), judged_(judged) {
    std::string pattern = testing::TempDir() + "generated_XXXXXX";
    folder_ = mkdtemp(pattern.data()) == nullptr ? "" : pattern;
    write(name + ".h", code.header);
    write(name + ".c", code.source);
    write("main.c", mainText());
  }
  ~GeneratedProgram() { std::filesystem::remove_all(folder_); }
  GeneratedProgram(const GeneratedProgram&) = delete;

  /// Compiles it; returns what the compiler says, empty if it says nothing.
  std::string compile(const std::string& compiler, const std::string& options) {
    const std::string log = folder_ + "/log";
    const std::string command = "cd '" + folder_ + "' && " + compiler + " " + options + " " +
                                name_ + ".c main.c -o program -lm >log 2>&1";
    const int status = std::system(command.c_str());
    return read(log) + (status == 0 ? "" : "\nthe compiler failed: " + command);
  }

  /// Compiles the generated file alone. @returns what the compiler says, or the names of what the
  /// object takes from elsewhere, one a line and in order.
  std::string needs(const std::string& compiler, const std::string& options) {
    const std::string command = "cd '" + folder_ + "' && { " + compiler + " " + options + " -c " +
                                name_ + ".c -o part.o && nm -u part.o | sed 's/.* //'; } >log 2>&1";
    const int status = std::system(command.c_str());
    return read(folder_ + "/log") + (status == 0 ? "" : "the compiler failed: " + command);
  }

  /// Runs it on samples, the inputs of each in a row. @returns for each sample the results of the
  /// function for one, then those of blocks.
  std::vector<double> run(const std::vector<double>& rows) {
    write("in", std::string(reinterpret_cast<const char*>(rows.data()), 8 * rows.size()));
    const int status = std::system(("cd '" + folder_ + "' && ./program <in >out 2>log").c_str());
    EXPECT_EQ(status, 0) << read(folder_ + "/log");
    const std::string bytes = read(folder_ + "/out");
    std::vector<double> results(bytes.size() / 8);
    std::memcpy(results.data(), bytes.data(), 8 * results.size());
    return results;
  }

 private:
  void write(const std::string& file, const std::string& text) {
    std::ofstream(folder_ + "/" + file, std::ios::binary) << text;
  }
  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  // Arguments that point to the arrays in a row, or in columns.
  std::string arguments(bool columns) const {
    std::string text;
    const auto add = [&](const char* array, const std::vector<int>& counts) {
      int at = 0;
      for (const int count : counts) {
        text += text.empty() ? "" : ", ";
        text += std::string(array) + " + " + std::to_string(at) + (columns ? " * stride" : "");
        at += count;
      }
    };
    add("in", inputs_);
    add("out", outputs_);
    return text;
  }

  std::string mainText() const {
    int in = 0, out = judged_ ? 1 : 0;
    for (const int count : inputs_) in += count;
    for (const int count : outputs_) out += count;
    return "#include \"" + name_ +
           ".h\"\n#include <stdio.h>\n#include <stdlib.h>\nenum { IN = " + std::to_string(in) +
           ", OUT = " + std::to_string(out) + R"(, MOST = 100000 };
static void one(const double *in, double *out) { )" +
           (judged_ ? "out[OUT - 1] = " : "") + name_ + "_compute(" + arguments(false) + R"(); }
static void block(size_t samples, size_t stride, const double *in, double *out) {
)" + (judged_ ? "  int *status = (int *)malloc(sizeof(int) * samples);\n  size_t i;\n" : "") +
           "  " + name_ + "_compute_block(samples, stride, " + arguments(true) +
           (judged_ ? ", status" : "") + ");\n" +
           (judged_ ? "  for (i = 0; i < samples; ++i) out[(OUT - 1) * stride + i] = status[i];\n"
                      "  free(status);\n"
                    : "") +
           R"(}
int main(void) {
  double *rows = (double *)malloc(sizeof(double) * IN * MOST);
  size_t n = fread(rows, sizeof(double) * IN, MOST, stdin), stride = n + 3, i, c;
  double *ones = (double *)malloc(sizeof(double) * OUT * n);
  double *in = (double *)malloc(sizeof(double) * IN * stride);
  double *out = (double *)malloc(sizeof(double) * OUT * stride);
  for (i = 0; i < n; ++i) {
    double sample[IN], results[OUT];
    for (c = 0; c < IN; ++c) sample[c] = in[c * stride + i] = rows[i * IN + c];
    one(sample, results);
    for (c = 0; c < OUT; ++c) ones[i * OUT + c] = results[c];
  }
  block(n, stride, in, out);
  for (i = 0; i < n; ++i) {
    fwrite(ones + i * OUT, sizeof(double), OUT, stdout);
    for (c = 0; c < OUT; ++c) fwrite(out + c * stride + i, sizeof(double), 1, stdout);
  }
  free(rows);
  free(ones);
  free(in);
  free(out);
  return 0;
}
)";
  }

  const std::string name_;
  const std::vector<int> inputs_, outputs_;
  const bool judged_;
  std::string folder_;
};

}  // namespace virtual_work_dynamics
