#include "generate/c_source.h"

#include <algorithm>
#include <set>

#include "generate/c_names.h"
#include "generate/c_operations.h"
#include "generate/c_prelude.h"

namespace virtual_work_dynamics {

namespace {

using Names = std::vector<std::string>;

// Arrays of angles have room for the widest packs.
constexpr std::size_t kWidest = 8;

// Puts names in place of the marks of c_prelude.h.
std::string filled(const std::string& text, const std::string& name, const std::string& pack = "") {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char mark = text[i] == '$' && i + 1 < text.size() ? text[i + 1] : ' ';
    if (mark == ' ') {
      result += text[i];
      continue;
    }
    const std::string& word = mark == 'n' || mark == 'N' ? name : pack;
    result += mark == 'N' || mark == 'P' ? inCapitals(word) : word;
    ++i;
  }
  return result;
}

std::string listed(const Names& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// Breaks the words between commas into lines.
std::string lines(const std::string& begin, const Names& words, const std::string& end) {
  constexpr std::size_t kLongest = 96;
  std::string text = begin, line;
  std::size_t at = begin.size();
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = words[i] + (i + 1 < words.size() ? "," : end);
    if (at + word.size() > kLongest) {
      text += "\n    ";
      at = 4;
    } else if (i > 0) {
      text += " ";
      ++at;
    }
    text += word;
    at += word.size();
  }
  return words.empty() ? begin + end : text;
}

// An array as a parameter.
std::string declared(const NamedArray& array, const std::string& type, bool of_block) {
  if (of_block) return type + " *" + array.name;
  return type + " " + array.name + "[" + std::to_string(array.count) + "]";
}

// The results but a status, which is handed over as a number of another type.
std::vector<NamedArray> resultsOf(const RecordedPlan& recording) {
  std::vector<NamedArray> results = recording.outputs;
  if (recording.judged) results.pop_back();
  return results;
}

class Source {
 public:
  explicit Source(const SourceContent& content)
      : content_(content), name_(content.name), capitals_(inCapitals(name_)) {
    for (const Node& node : graph().nodes()) {
      held_ = held_ || node.operation == Operation::kHeld;
      exact_ = exact_ || node.operation == Operation::kProductRest;
    }
  }

  std::string text() {
    out_ = content_.head + "#include \"" + name_ + ".h\"\n";
    out_ += filled(kPrelude, name_);
    const bool turns = !graph().angles().empty();
    out_ += filled(kPacks, name_, "pack");
    if (turns) out_ += filled(kSineConstants, name_) + filled(kPackSines, name_, "pack");
    if (judged()) out_ += filled(kRoots, name_) + filled(kPackChoices, name_);
    out_ += filled(kOneSample, name_);
    out_ += filled(kPacks, name_, "few");
    if (turns) out_ += filled(kPackSines, name_, "few") + filled(kSines, name_);
    smallFunctions();
    parts(false);
    computeFunction();
    out_ += filled(kOneSampleEnd, name_);
    smallFunctionsOfPacks();
    oneOfBlock();
    out_ += "\n#if " + packsExist();
    parts(true);
    packFunction();
    out_ += "#endif\n";
    blockFunction();
    return out_ + kEnding;
  }

 private:
  const ExpressionGraph& graph() const { return content_.recording.graph; }
  bool judged() const { return content_.recording.judged; }
  std::string angleCount() const { return std::to_string(graph().angles().size()); }

  void smallFunctions() {
    if (!held_) return;
    out_ += filled(R"(
/* Returns x, or 1 or -1 where x is beyond. */
$N_WITHIN double $n_held(double x) { return x < -1.0 ? -1.0 : x > 1.0 ? 1.0 : x; }
)",
                   name_);
  }

  void smallFunctionsOfPacks() {
    if (held_) {
      out_ += filled(R"(
#if $N_PACK_WIDTH > 1
$N_WITHIN $n_pack $n_pack_held($n_pack x) {
  int i;
  for (i = 0; i < $N_PACK_WIDTH; ++i) x[i] = $n_held(x[i]);
  return x;
}
#endif
)",
                     name_);
    }
    if (exact_) {
      out_ += filled(R"(
/* What rounding took of a product. */
#if $N_PACK_WIDTH > 1
$N_WITHIN $n_pack $n_exact_rest($n_pack a, $n_pack b, $n_pack product) {
  int i;
  for (i = 0; i < $N_PACK_WIDTH; ++i) a[i] = $N_EXACT_FMA(a[i], b[i], -product[i]);
  return a;
}
#endif
)",
                     name_);
    }
  }

  std::string packsExist() const {
    return capitals_ + "_PACK_WIDTH > 1" +
           (graph().angles().empty() ? "" : " && !" + capitals_ + "_BY_LIBRARY");
  }

  // The arrays that a part reads and writes, and their types; and how they are handed over.
  struct Handed {
    Names parameters, arguments;
  };
  Handed handedTo(const ProgramPart& part, bool last, bool packs) const {
    std::set<int> inputs, outputs;
    std::set<int> angle_parts;
    const auto leaf = [&](const Term& term) {
      if (!term.isNode()) return;
      const Node& node = graph().nodes()[term.node()];
      if (node.operation == Operation::kInput) inputs.insert(node.array);
      if (node.operation == Operation::kAngle) angle_parts.insert(node.array);
    };
    std::set<std::uint32_t> here(part.nodes.begin(), part.nodes.end());
    for (const std::uint32_t node : part.nodes) {
      for (int i = 0; i < operandsOf(graph().nodes()[node]); ++i) {
        leaf(operandOf(graph().nodes()[node], i));
      }
    }
    for (const GraphOutput& output : graph().outputs) {
      const bool operation = output.value.isNode() && !isLeaf(graph().nodes()[output.value.node()]);
      if (operation ? here.count(output.value.node()) > 0 : last) outputs.insert(output.array);
      if (!operation && last) leaf(output.value);
    }
    Handed handed;
    const std::string item = packs ? name_ + "_pack" : "double";
    const auto add = [&](const std::string& type, const std::string& array) {
      handed.parameters.push_back(type + " *" + capitals_ + "_RESTRICT " + array);
      handed.arguments.push_back(array);
    };
    for (const int i : inputs) add("const double", content_.recording.inputs[std::size_t(i)].name);
    static const char* const kParts[] = {"cosine", "sine", "rest"};
    for (const int i : angle_parts) add("const " + item, kParts[i]);
    if (!part.taken.empty() || !part.kept.empty()) add(item, "m");
    for (const int i : outputs) add("double", content_.recording.outputs[std::size_t(i)].name);
    if (packs && (!inputs.empty() || !outputs.empty())) {
      handed.parameters.insert(handed.parameters.begin(), "size_t stride");
      handed.arguments.insert(handed.arguments.begin(), "stride");
    }
    return handed;
  }

  std::string partName(std::size_t p, bool packs) const {
    return name_ + (packs ? "_pack_part_" : "_part_") + std::to_string(p);
  }

  void parts(bool packs) {
    OperationWriter writer(name_, content_.recording, packs);
    const std::vector<ProgramPart>& all = content_.program.parts;
    for (std::size_t p = 0; p < all.size(); ++p) {
      const bool last = p + 1 == all.size();
      const Names parameters = handedTo(all[p], last, packs).parameters;
      out_ += "\n" + capitals_ + (all.size() > 1 ? "_APART static void " : "_WITHIN void ");
      out_ +=
          lines(partName(p, packs) + "(", parameters.empty() ? Names{"void"} : parameters, ") {\n");
      out_ += writer.part(all[p], last) + "}\n";
    }
  }

  void callParts(bool packs) {
    const std::vector<ProgramPart>& all = content_.program.parts;
    for (std::size_t p = 0; p < all.size(); ++p) {
      const Names arguments = handedTo(all[p], p + 1 == all.size(), packs).arguments;
      out_ += "  " + partName(p, packs) + "(" + listed(arguments) + ");\n";
    }
  }

  void declareMemory(const std::string& item, std::size_t room) {
    const std::string count = "[" + std::to_string(room) + "]";
    if (!graph().angles().empty()) {
      const bool packs = item != "double";
      out_ += "  " + item + (packs ? " angle" + count + "," : "") + " sine" + count + ", cosine" +
              count;
      out_ += (content_.recording.anyRest() ? ", rest" + count : "") + ";\n";
    }
    if (content_.program.slots > 0) {
      out_ += "  " + item + " m[" + std::to_string(content_.program.slots) + "];\n";
    }
  }

  // Says that arrays of which the scene needs nothing are not forgotten.
  void ignoreInputs() {
    for (const NamedArray& array : content_.recording.inputs)
      out_ += "  (void)" + array.name + ";\n";
  }

  Names parameters(bool of_block) const {
    Names result;
    for (const NamedArray& array : content_.recording.inputs) {
      result.push_back(declared(array, "const double", of_block));
    }
    for (const NamedArray& array : resultsOf(content_.recording)) {
      result.push_back(declared(array, "double", of_block));
    }
    if (of_block && judged()) result.push_back("int *status");
    if (of_block) result.insert(result.begin(), {"size_t samples", "size_t stride"});
    return result;
  }

  Names arrays() const {
    Names result;
    for (const NamedArray& array : content_.recording.inputs) result.push_back(array.name);
    for (const NamedArray& array : content_.recording.outputs) result.push_back(array.name);
    return result;
  }

  void computeFunction() {
    const std::size_t angles = graph().angles().size();
    const std::size_t room = (angles + kWidest - 1) / kWidest * kWidest;
    out_ += "\n" +
            lines((judged() ? "int " : "void ") + name_ + "_compute(", parameters(false), ") {\n");
    declareMemory("double", room);
    if (judged()) out_ += "  double status[1];\n";
    if (angles > 0) out_ += "  int every;\n";
    ignoreInputs();
    if (angles > 0) {
      OperationWriter writer(name_, content_.recording, false);
      out_ += writer.angles();
    }
    callParts(false);
    out_ += judged() ? "  return (int)status[0];\n}\n" : "}\n";
  }

  // Computes a sample of a block by the function for one.
  void oneOfBlock() {
    Names all = parameters(true);
    all.erase(all.begin());  // the number of samples
    out_ += "\nstatic " + lines("void " + name_ + "_one_of_block(", all, ") {\n");
    std::string locals, reads, writes;
    Names arguments;
    const auto add = [&](const NamedArray& array, bool input) {
      const std::string local = "one_" + array.name, count = std::to_string(array.count);
      locals += "  double " + local + "[" + count + "];\n";
      const std::string loop = "  for (i = 0; i < " + count + "; ++i) ";
      if (input) {
        reads += loop + local + "[i] = " + array.name + "[i * stride];\n";
      } else {
        writes += loop + array.name + "[i * stride] = " + local + "[i];\n";
      }
      arguments.push_back(local);
    };
    for (const NamedArray& array : content_.recording.inputs) add(array, true);
    for (const NamedArray& array : resultsOf(content_.recording)) add(array, false);
    out_ += locals + "  size_t i;\n" + reads + "  " + (judged() ? "*status = " : "") + name_ +
            "_compute(" + listed(arguments) + ");\n" + writes + "}\n";
  }

  // Computes a pack of samples; returns 0 where an angle is too large for it.
  void packFunction() {
    Names all = parameters(true);
    all.erase(all.begin());  // the number of samples
    if (judged()) all.back() = "int *verdict";
    out_ += "\nstatic " + lines("int " + name_ + "_pack_of_block(", all, ") {\n");
    if (judged()) out_ += "  double status[" + capitals_ + "_PACK_WIDTH];\n  int j;\n";
    declareMemory(name_ + "_pack", graph().angles().size());
    if (!graph().angles().empty()) out_ += "  int i, every = 1;\n";
    ignoreInputs();
    out_ += "  (void)stride;\n";
    if (!graph().angles().empty()) {
      OperationWriter writer(name_, content_.recording, true);
      out_ += writer.angles();
      out_ += "  for (i = 0; i < " + angleCount() + "; ++i) {\n    every &= " + name_ +
              "_pack_sine_cosine(angle[i], &sine[i], &cosine[i]);\n  }\n  if (!every) return 0;\n";
    }
    callParts(true);
    if (judged()) {
      out_ += "  for (j = 0; j < " + capitals_ + "_PACK_WIDTH; ++j) verdict[j] = (int)status[j];\n";
    }
    out_ += "  return 1;\n}\n";
  }

  void blockFunction() {
    Names at = {"stride"};
    for (const std::string& array : arrays()) at.push_back(array + " + n");
    out_ += "\n" + lines("void " + name_ + "_compute_block(", parameters(true), ") {\n");
    out_ += "  size_t n = 0;\n";
    out_ += "#if " + packsExist() + "\n";
    out_ += "  for (; n + " + capitals_ + "_PACK_WIDTH <= samples; n += " + capitals_ +
            "_PACK_WIDTH) {\n";
    out_ += "    size_t end = n + " + capitals_ + "_PACK_WIDTH;\n";
    out_ += "    if (" + name_ + "_pack_of_block(" + listed(at) + ")) continue;\n";
    out_ += "    for (; n < end; ++n) " + name_ + "_one_of_block(" + listed(at) + ");\n";
    out_ += "    n -= " + capitals_ + "_PACK_WIDTH;\n  }\n#endif\n";
    out_ += "  for (; n < samples; ++n) " + name_ + "_one_of_block(" + listed(at) + ");\n}\n";
  }

  const SourceContent& content_;
  const std::string name_, capitals_;
  bool held_ = false, exact_ = false;
  std::string out_;
};

}  // namespace

std::string cSource(const SourceContent& content) {
  return Source(content).text();
}

std::string cDeclarations(const std::string& name, const RecordedPlan& recording) {
  Names one, block = {"size_t samples", "size_t stride"};
  std::string says;
  const auto add = [&](const NamedArray& array, const std::string& type) {
    one.push_back(declared(array, type, false));
    block.push_back(declared(array, type, true));
    says += "   " + array.name + "[" + std::to_string(array.count) + "]: " + array.says + "\n";
  };
  for (const NamedArray& array : recording.inputs) add(array, "const double");
  says += "   Results:\n";
  for (const NamedArray& array : resultsOf(recording)) add(array, "double");
  if (recording.judged) {
    says += "   Returns a status, see above.\n";
    block.push_back("int *status");
  }
  return "\n/* One sample. Numbers must be finite, and arrays must not overlap. Allocates nothing, "
         "keeps "
         "no state:\n   may be called from any thread.\n" +
         says + "*/\n" +
         lines((recording.judged ? "int " : "void ") + name + "_compute(", one, ");\n") +
         "\n/* Several samples: number c of sample n is at [c * stride + n] of each array, stride "
         ">= "
         "samples." +
         (recording.judged ? " The status of\n   sample n is at [n]. */\n" : " */\n") +
         lines("void " + name + "_compute_block(", block, ");\n");
}

}  // namespace virtual_work_dynamics
