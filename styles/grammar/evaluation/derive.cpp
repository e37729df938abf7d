// The derivation: shapes wait for their rules level by level; what no rule takes is a leaf
// (docs/rule_language.md §4.1, §4.2).
#include "styles/grammar/evaluation/derive.h"

#include <algorithm>

#include "pipeline/base/random.h"
#include "styles/grammar/evaluation/run.h"
#include "styles/grammar/language/value_text.h"

namespace blockrand::grammar {
namespace {

/// Keeps seeds of children apart from the numbers that their parent draws.
constexpr std::uint64_t kChildSeeds = base::hash_text("child");

std::vector<RuleFacts> facts_of(const Program& program) {
  std::vector<RuleFacts> out;
  for (const Definition& definition : program.definitions) {
    RuleFacts facts;
    const Unit& unit = program.unit(definition.module);
    const Declaration& declaration = unit.declarations[definition.declaration];
    for (const Annotation& annotation : Unit::slice(unit.annotations, declaration.annotations)) {
      if (annotation.name != "Consistent" && annotation.name != "@Consistent") continue;
      const bool row = annotation.arguments.find("row") != std::string::npos;
      facts.consistency = row ? Consistency::row : Consistency::building;
    }
    // Not the qualified name: a rule stays itself when its file is imported under another prefix.
    facts.name_hash = base::hash_text(unit.name(declaration.name));
    out.push_back(facts);
  }
  return out;
}

}  // namespace

/// Whether a file asks about what stands around (docs/rule_language.md §4.6): then there are two derivations.
bool asks_around(const Program& program) {
  for (const Module& module : program.modules)
    for (const Target& target : module.targets)
      if (target.kind == TargetKind::function &&
          built_in_actions().special_functions[target.index] == &Run::context_query)
        return true;
  return false;
}

struct Deriver::Prepared {
  const Program& program;
  std::vector<RuleFacts> facts;
  bool asks_around = false;
};

Deriver::Deriver(const Program& program)
    : prepared_(new Prepared{program, facts_of(program), grammar::asks_around(program)}) {}
Deriver::~Deriver() = default;
Deriver::Deriver(Deriver&&) noexcept = default;

Derivation Deriver::run(const Shape& initial, const DeriveOptions& options) const {
  if (!prepared_->asks_around) return Run(prepared_->program, prepared_->facts, initial, options).go();
  Surroundings seen_around;
  Run first(prepared_->program, prepared_->facts, initial, options);
  first.record(seen_around);
  Derivation out = first.go();
  if (!seen_around.asked || seen_around.occluders.empty()) return out;
  Run second(prepared_->program, prepared_->facts, initial, options);
  second.answer_from(seen_around);
  return second.go();
}

std::vector<std::uint32_t> Deriver::outside_values(const std::vector<std::pair<std::string, Value>>& attributes) const {
  std::vector<std::uint32_t> out;
  for (const Slot& slot : prepared_->program.slots) out.push_back(find_outside(slot, attributes));
  return out;
}

Derivation derive(const Program& program, const Shape& initial, const DeriveOptions& options) {
  return Deriver(program).run(initial, options);
}

const Report* Derivation::report(std::string_view key) const {
  const auto found = std::find_if(reports.begin(), reports.end(), [&](const Report& r) { return r.key == key; });
  return found == reports.end() ? nullptr : &*found;
}

std::string tree_key(const Derivation& derivation, std::uint32_t node) {
  std::vector<std::uint32_t> way;
  for (; node < derivation.tree.size(); node = derivation.tree[node].parent)
    way.push_back(derivation.tree[node].ordinal);
  std::string out;
  for (auto step = way.rbegin(); step != way.rend(); ++step) out += std::to_string(*step) + ";";
  return out;
}

Run::Run(const Program& program, const std::vector<RuleFacts>& facts, const Shape& initial,
         const DeriveOptions& options)
    : program_(program), facts_(facts), options_(options), initial_(initial) {
  locals_.reserve(256);
  if (options.without != nullptr) without_ = built_in_number(*options.without);
  initial_.seed = options.seed;
  initial_.draws = 0;
}

std::string Run::key_of(std::uint32_t node) const {
  std::vector<std::uint32_t> way;
  for (; node != kNone; node = links_[node].parent) way.push_back(links_[node].ordinal);
  std::string out;
  for (auto step = way.rbegin(); step != way.rend(); ++step) out += std::to_string(*step) + ";";
  return out;
}

void Run::tell(Severity severity, std::string_view code, const Location& location, std::string message,
               std::string offending, std::string suggestion) {
  own_ = true;  // each derivation tells what it finds
  if (!told_.emplace(std::string(code), std::array{location.file, location.line, location.column}).second) return;
  if (out_.diagnostics.size() >= options_.limits.diagnostics) {
    ++out_.untold;
    return;
  }
  out_.diagnostics.push_back(
      {severity, std::string(code), location, std::move(message), std::move(offending), std::move(suggestion)});
}

std::uint64_t Run::child_seed(Work& work) const {
  return base::mix64(base::mix64(base::mix64(work.shape.seed) ^ work.seeds++) ^ kChildSeeds);
}

std::uint32_t Run::child_lineage(const Work& work) {
  if (recorded_ == nullptr && known_ == nullptr) return kNone;
  lineages_.push_back({work.lineage, work.seeds});
  return static_cast<std::uint32_t>(lineages_.size() - 1);
}

std::vector<std::uint32_t> Run::way_of(std::uint32_t lineage) const {
  std::vector<std::uint32_t> out;
  for (; lineage != kNone; lineage = lineages_[lineage].parent) out.push_back(lineages_[lineage].ordinal);
  std::reverse(out.begin(), out.end());
  return out;
}

void Run::keep_occluder(const Shape& shape, std::uint32_t lineage, std::string label) {
  if (recorded_ == nullptr) return;
  Occluder made = occluder_of(shape);
  if (made.mesh.empty() && label.empty()) return;
  made.lineage = way_of(lineage);
  made.label = std::move(label);
  recorded_->occluders.push_back(std::move(made));
}

namespace {

/// Whether a rule of the start file is missing since it could not be read.
bool rule_unread(const Program& program) {
  const Unit& unit = program.unit(0);
  for (const Declaration& declaration : unit.declarations)
    if (declaration.broken && declaration.kind == DeclarationKind::rule) return true;
  // Not even its head: "Lot -> X".
  for (const Diagnostic& d : program.diagnostics)
    if (d.code == "syntax" && d.severity == Severity::error && d.location.file == unit.file) return true;
  return false;
}

}  // namespace

Derivation Run::go() {
  const char here = 0;
  stack_start_ = &here;
  if (program_.modules.empty()) {
    tell(Severity::error, "no_program", {}, "the rule file could not be read; there is nothing to derive");
    return std::move(out_);
  }
  const std::uint32_t start =
      options_.start_rule.empty() ? program_.start_rule : find_start_rule(program_, options_.start_rule);
  if (start != kNone) start_name_ = program_.qualified_name(program_.definitions[start]);
  evaluate_attributes();
  if (start == kNone) {
    // Where a rule could not be read, loading has told why there is none.
    if (options_.start_rule.empty() && rule_unread(program_)) return std::move(out_);
    tell(Severity::error, "no_start_rule", {},
         options_.start_rule.empty() ? "there is no rule to begin with"
                                     : "there is no rule of this name without parameters",
         options_.start_rule);
    return std::move(out_);
  }
  const Definition& definition = program_.definitions[start];
  Node root;
  root.shape = initial_;
  root.definition = start;
  root.symbol = program_.qualified_name(definition);
  root.location = program_.declaration(definition).location;
  links_.push_back({});
  if (options_.keep_tree)
    out_.tree.push_back({.symbol = root.symbol, .definition = start, .location = root.location, .shape = root.shape});
  level_.push_back(std::move(root));
  while (!level_.empty()) {
    for (Node& node : level_) apply(node);
    level_.clear();
    std::swap(level_, next_);
  }
  out_.shapes = links_.size();
  for (auto& [key, report] : reports_) {
    if (report.count > 0) report.mean = report.sum / static_cast<double>(report.count);
    out_.reports.push_back(std::move(report));
  }
  return std::move(out_);
}

void Run::apply(Node& node) {
  const Definition& definition = program_.definitions[node.definition];
  const Declaration& declaration = program_.declaration(definition);
  const RuleFacts& facts = facts_[node.definition];
  rule_ = {node.number, facts.consistency, 0, declaration.location.line};
  if (facts.consistency != Consistency::none)
    rule_.consistent_key =
        base::mix64(base::mix64(facts.consistency == Consistency::row ? options_.row_seed : options_.building_seed) ^
                    facts.name_hash);
  node_ = &node;
  ordinals_ = 0;
  locals_.clear();
  for (Value& argument : node.arguments) locals_.push_back(std::move(argument));
  Work work;
  work.shape = node.shape;
  work.base = &node.shape;
  work.lineage = node.lineage;
  Place place{
      .module = definition.module, .shape = &work.shape, .rule = &rule_, .own_text = true, .lineage = node.lineage};
  push_bindings(declaration, place);
  if (declaration.successor != kNone) execute(declaration.successor, work, place, true);
  if (work.alive && !work.produced)
    leave_leaf(node.symbol, std::move(work.shape), node.location, node.number, node.lineage);
}

void Run::leave_leaf(std::string symbol, Shape shape, const Location& location, std::uint32_t node,
                     std::uint32_t lineage, std::shared_ptr<const ElementRequest> order) {
  keep_occluder(shape, lineage);
  if (options_.orders_only && order == nullptr) return;
  out_.leaves.emplace_back(std::move(symbol), std::move(shape), std::move(order), node, location);
}

}  // namespace blockrand::grammar
