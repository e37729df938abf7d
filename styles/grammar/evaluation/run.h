// One derivation while it runs. Internal to this folder: evaluate_*.cpp and derive_*.cpp share it.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "styles/grammar/evaluation/derive.h"
#include "styles/grammar/shapes/components.h"
#include "styles/grammar/shapes/occlusion.h"
#include "styles/grammar/shapes/operations.h"
#include "styles/grammar/shapes/split.h"

namespace blockrand::grammar {

enum class Consistency : std::uint8_t { none, building, row };

/// Draws numbers of the shape that a rule works on, unless the rule is to be consistent.
struct RuleContext {
  std::uint32_t node = kNone;
  Consistency consistency = Consistency::none;
  std::uint64_t consistent_key = 0;  ///< hash of (seed, rule name)
  std::uint32_t first_line = 0;      ///< of the rule: keys of choices count from it
};

/// A value that is a number or a truth value mostly: these are kept apart, since a Value costs more to hand on.
struct Scalar {
  Type type = Type::number;
  bool truth = false;
  double number = 0;
  std::optional<Value> other;  ///< of the other types

  static Scalar of(double value) { return {.type = Type::number, .number = value, .other = {}}; }
  static Scalar of(bool value) { return {.type = Type::truth, .truth = value, .other = {}}; }
  static Scalar of(Value&& value);
  Value value() &&;
};

/// A component that a selector expression is tried on.
struct ComponentTest {
  const ComponentSplit* split = nullptr;
  std::size_t item = 0;
};

/// Where an expression is evaluated.
struct Place {
  std::uint32_t module = 0;
  std::size_t frame = 0;              ///< its first local value in Run::locals_
  Shape* shape = nullptr;             ///< what it reads, and whose random numbers it draws
  const RuleContext* rule = nullptr;  ///< null in the attribute phase
  bool own_text = false;              ///< the rule's own successor, not a function that it calls
  const ComponentTest* component = nullptr;
  std::uint32_t lineage = kNone;  ///< of the shape, in Run::lineages_
};

/// A shape that waits for its rule.
struct Node {
  Shape shape;
  std::uint32_t number = 0, depth = 0;  ///< number: in Run::links_
  std::uint32_t definition = kNone;
  std::string symbol;
  std::vector<Value> arguments;
  Location location;
  std::uint32_t lineage = kNone;  ///< in Run::lineages_
};

/// What the steps of a rule, or of a block's item, work on.
struct Work {
  Shape shape;                    ///< the current shape
  const Shape* base = nullptr;    ///< the previous one on the stack
  std::uint32_t seeds = 0;        ///< children and pieces made: their seeds go by it
  bool alive = true;              ///< false after NIL
  bool produced = false;          ///< a child was made, or pieces were
  std::uint32_t lineage = kNone;  ///< in Run::lineages_
};

/// Which of these gives the slot's value; kNone: none.
std::uint32_t find_outside(const Slot& slot, const std::vector<std::pair<std::string, Value>>& attributes);

class Run;
/// A function that needs the shape or the tree. Arguments are evaluated by it.
using SpecialFunction = Value (Run::*)(const Expression&, Place&);
using SpecialStep = void (Run::*)(const Call&, Work&, Place&);

/// What there is to do for each name of the language, by its number. Made once.
struct BuiltInActions {
  std::vector<std::span<const FunctionEntry>> functions;
  std::vector<SpecialFunction> special_functions;
  std::vector<const OperationEntry*> operations;
  std::vector<SpecialStep> special_steps;
  std::vector<Value (*)(const Shape&)> attributes;  ///< the frequent ones; null: read_attribute
};
const BuiltInActions& built_in_actions();

/// What the first of two derivations leaves for context queries of the second (docs/rule_language.md §4.6).
struct Surroundings {
  std::vector<Occluder> occluders;
  bool asked = false;  ///< a query was made that the occluders answer
};

/// What is known of a program before it runs.
struct RuleFacts {
  Consistency consistency = Consistency::none;
  std::uint64_t name_hash = 0;
};

class Run {
 public:
  Run(const Program& program, const std::vector<RuleFacts>& facts, const Shape& initial, const DeriveOptions& options);
  Derivation go();
  /// Before go(): the first derivation, whose queries have default answers, records what stands there; the second
  /// answers from it.
  void record(Surroundings& to) { recorded_ = &to; }
  void answer_from(const Surroundings& from) { known_ = &from; }

  // Functions that need the shape (evaluate_shape_functions.cpp).
  Value geometry_number(const Expression& e, Place& place);
  Value geometry_truth(const Expression& e, Place& place);
  Value geometry_words(const Expression& e, Place& place);
  Value geometry_uv(const Expression& e, Place& place);
  Value context_query(const Expression& e, Place& place);
  Value context_default(const Expression& e, Place& place);
  Value convert_coordinates(const Expression& e, Place& place);
  Value edge_attribute(const Expression& e, Place& place);
  Value current_tree_key(const Expression& e, Place& place);
  Value print_value(const Expression& e, Place& place);
  Value component_words(const Expression& e, Place& place);
  Value tagged(const Expression& e, Place& place);

  // Steps that are no operations on the shape (derive_steps.cpp, derive_blocks.cpp).
  void step_nil(const Call&, Work&, Place&);
  void step_set(const Call&, Work&, Place&);
  void step_report(const Call&, Work&, Place&);
  void step_print(const Call&, Work&, Place&);
  void step_label(const Call&, Work&, Place&);
  void step_not_yet(const Call&, Work&, Place&);
  void step_split(const Call&, Work&, Place&);
  void step_split_area(const Call&, Work&, Place&);
  void step_components(const Call&, Work&, Place&);
  void step_setback(const Call&, Work&, Place&);
  void step_setback_per_edge(const Call&, Work&, Place&);
  void step_setback_to_area(const Call&, Work&, Place&);
  void step_shape_luo(const Call&, Work&, Place&);
  void step_inner_rectangle(const Call&, Work&, Place&);
  void step_scatter(const Call&, Work&, Place&);

 private:
  // Expressions (evaluate.cpp).
  Value evaluate(NodeId id, Place& place);
  /// What evaluate() gives.
  Scalar scalar(NodeId id, Place& place);
  Scalar scalar_of_operator(const Expression& e, Place& place);
  /// A value that is there already and can be read where it is, as long as no other expression is evaluated; null: none.
  const Value* known_value(const Expression& e, const Place& place) const;
  Value evaluate_name(const Expression& e, Place& place);
  Value evaluate_index(const Expression& e, Place& place);
  Value evaluate_index_part(NodeId id, Place& place);
  Value evaluate_array(const Expression& e, Place& place);
  Value evaluate_cases(const Expression& e, Place& place);
  Value evaluate_chances(const Expression& e, Place& place);
  Value evaluate_component_map(const Expression& e, Place& place);
  Value call_function(const Expression& e, const Target& target, Place& place);
  Scalar call_own(const Expression& e, const Target& target, Place& place);
  Value read_shape_attribute(const Expression& e, std::uint32_t number, Place& place);
  Value read_attribute_slot(std::uint32_t slot, Place& place);
  Value read_source(const Expression& e, std::string_view name);
  double number(NodeId id, Place& place);
  bool condition(NodeId id, Place& place);
  std::string text(NodeId id, Place& place);
  /// The branch that a draw takes; percentages are evaluated left to right.
  std::size_t draw_branch(Range branches, const Location& location, Place& place);
  /// A number in [0, 1) for a choice at `location`.
  double draw_choice(const Location& location, Place& place);
  /// A bare word, or the text that stands for one; empty where the argument is something else.
  std::string_view word(const ArgumentNode& argument, Place& place);
  /// Whether DeriveOptions::without takes this name out.
  bool without(std::uint32_t number) const { return number == without_; }
  bool without_selector(std::string_view name) const {
    return options_.without != nullptr && options_.without->kind == NameKind::selector &&
           options_.without->name == name;
  }
  const Target& target(std::uint32_t module, UseId use) const { return program_.modules[module].targets[use]; }
  FunctionContext function_context(Place& place);
  void take_warnings(const Location& location);
  std::span<const ArgumentNode> arguments(Range range, const Place& place) const {
    return Unit::slice(program_.unit(place.module).arguments, range);
  }
  /// Evaluates arguments onto the end of locals_; the caller cuts them off again. \returns where they begin
  std::size_t push_arguments(Range range, Place& place);
  void push_bindings(const Declaration& declaration, Place& place);
  bool too_deep(const Location& location);
  void tell_too_many_calls(const Location& location, const std::string& name);
  /// Further pieces are left out (run_item tells): nothing needs to be made for them.
  bool pieces_full() const { return pieces_ > options_.limits.pieces; }

  // Attributes (derive_attributes.cpp).
  void evaluate_attributes();
  void evaluate_slot(std::uint32_t slot);
  Value outside_value(std::uint32_t slot, bool& found);
  bool is_own(std::string_view source_name) const {
    return options_.is_shared == nullptr || !options_.is_shared(source_name);
  }
  void enter_dynamic(std::uint32_t module, Shape& shape, Place& importer);
  void set_slot(Shape& shape, std::uint32_t slot, Value value);

  // Rules (derive.cpp, derive_steps.cpp, derive_blocks.cpp).
  void apply(Node& node);
  /// \param last  nothing follows that needs work.shape: a symbol may take it
  void execute(NodeId successor, Work& work, Place& place, bool last);
  void execute_call(const Call& call, Work& work, Place& place, bool last);
  void execute_symbol(const Call& call, const Target& target, Work& work, Place& place, bool last);
  void execute_request(const Call& call, Work& work, Place& place, bool last);
  void execute_operation(const Call& call, std::uint32_t number, Work& work, Place& place);
  void run_item(NodeId successor, Shape piece, Work& parent, Place& place);
  void leave_leaf(std::string symbol, Shape shape, const Location& location, std::uint32_t node, std::uint32_t lineage,
                  std::shared_ptr<const ElementRequest> order = nullptr);
  std::uint64_t child_seed(Work& work) const;
  /// The lineage of the next child or piece of `work`; before child_seed().
  std::uint32_t child_lineage(const Work& work);
  std::vector<std::uint32_t> way_of(std::uint32_t lineage) const;
  /// Keeps the shape for context queries: only while the first of two derivations runs.
  void keep_occluder(const Shape& shape, std::uint32_t lineage, std::string label = {});
  void evaluate_operation_arguments(const Call& call, Place& place);
  std::vector<SplitItem> split_items(Range items, Place& place, std::vector<NodeId>& successors);
  /// Chooses among components, left to right, each taken once; calls `make` with each shape.
  void run_selectors(const Block& block, const ComponentSplit& split, Work& work, Place& place);
  std::vector<std::size_t> choose_components(NodeId selector, const ComponentSplit& split, std::vector<bool>& taken,
                                             std::string& text, Place& place);
  void run_strips(const Call& call, const std::vector<int>& chosen_by, const std::vector<double>& distances, Work& work,
                  Place& place);
  void run_shape_and_remainder(const Call& call, const struct ShapeAndRemainder& pieces, Work& work, Place& place);
  std::vector<int> edges_by_item(const Block& block, const ComponentSplit& edges, Place& place);
  std::string selector_text(NodeId selector, const Place& place) const;
  bool mentions_selector(NodeId id, const Place& place) const;

  void tell(Severity severity, std::string_view code, const Location& location, std::string message,
            std::string offending = {}, std::string suggestion = {});
  std::string key_of(std::uint32_t node) const;

  const Program& program_;
  const std::vector<RuleFacts>& facts_;
  const DeriveOptions& options_;
  std::uint32_t without_ = kNone;
  Shape initial_;
  Derivation out_;
  std::vector<Node> level_, next_;
  struct Link {
    std::uint32_t parent = kNone, ordinal = 0;
  };
  std::vector<Link> links_;         ///< of every shape with a symbol, for tree keys
  std::vector<Value> locals_;       ///< frames of rules and functions, and arguments on their way
  std::vector<Argument> operands_;  ///< of the operation that is about to run
  std::vector<std::string> warnings_;
  std::uint32_t function_depth_ = 0;
  const char* stack_start_ = nullptr;
  bool full_ = false;        ///< the limit of shapes was told
  bool told_calls_ = false;  ///< the limit of calls was told: where it was reached, no other place
  std::size_t pieces_ = 0, calls_ = 0;
  std::string start_name_;  ///< `initialShape.startRule`
  RuleContext rule_;
  Node* node_ = nullptr;        ///< whose rule runs
  std::uint32_t ordinals_ = 0;  ///< of its children
  std::set<std::pair<std::string, std::array<std::uint32_t, 3>>, std::less<>> told_;
  std::unordered_set<std::uint64_t> told_leaves_;  ///< uses of symbols without rule: told once
  std::map<std::string, std::optional<Value>, std::less<>> source_values_;
  mutable std::vector<std::vector<const Value*>>
      source_of_use_;  ///< by module and use: into source_values_; null: look there
  std::map<std::pair<std::string, Type>, Report> reports_;

  /// The attribute phase, at the start and for each dynamic import.
  struct AttributePhase {
    std::vector<Value> values;
    std::vector<std::uint8_t> state;  ///< 0 waiting, 1 under way, 2 done
    std::vector<bool> own;            ///< depends on this derivation alone: not for AttributeMemo
    Shape shape;                      ///< what defaults are evaluated on; seed and draws are those of the slot at work
    Place* importer = nullptr;        ///< dynamic imports: where the call stands
    bool outside = true;
  };
  AttributePhase* phase_ = nullptr;
  mutable bool own_ = false;  ///< the attribute that is evaluated read what is this derivation's own
  Surroundings* recorded_ = nullptr;
  const Surroundings* known_ = nullptr;
  std::vector<Link> lineages_;  ///< of every child and piece, while somebody asks for surroundings
};

}  // namespace blockrand::grammar
