// lobefit eval: a quantity of the papers, with its gradient, for each row of a CSV.
#include <cstdio>
#include <memory>

#include "tasks/eval_stream.h"
#include "verbs/verb.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/quantities/quantities.h"

namespace lobefit {
namespace {

struct EvalVerb {
  std::string quantity;
  bool list = false;
};

const Quantity& Find(const std::string& name) {
  if (const Quantity* quantity = FindQuantity(name)) return *quantity;
  std::vector<std::string> names;
  for (const Quantity& quantity : Quantities()) names.push_back(quantity.name);
  throw InputError(fmt::format("'{}' is not a quantity{}; the quantities are: {}; `lobefit eval --list` describes them",
                               Excerpt(name), DidYouMean(name, names), Join(names)));
}

void Describe(const Quantity& quantity) {
  fmt::print("{}\n  {}\n  source: {}\n  reads:\n", quantity.name, quantity.description, quantity.source);
  for (const InputColumn& column : quantity.inputs) {
    fmt::print("    {:<16} {:<6} {:<24} {}\n", column.name, column.unit, DomainText(column), column.meaning);
  }
  fmt::print("  writes:\n");
  for (const ResultColumn& column : quantity.results) {
    fmt::print("    {:<33} {:<13} {}\n", column.name, column.unit,
               column.meaning.empty() ? "partial derivative" : column.meaning);
  }
}

nlohmann::ordered_json Document(const Quantity& quantity) {
  nlohmann::ordered_json document = {{"name", quantity.name},
                                     {"description", quantity.description},
                                     {"source", quantity.source},
                                     {"inputs", nlohmann::ordered_json::array()},
                                     {"results", nlohmann::ordered_json::array()}};
  for (const InputColumn& column : quantity.inputs) {
    document["inputs"].push_back(
        {{"name", column.name}, {"unit", column.unit}, {"domain", DomainText(column)}, {"meaning", column.meaning}});
  }
  for (const ResultColumn& column : quantity.results) {
    document["results"].push_back({{"name", column.name},
                                   {"unit", column.unit},
                                   {"meaning", column.meaning.empty() ? "partial derivative" : column.meaning}});
  }
  return document;
}

void List(const EvalVerb& verb, bool json) {
  nlohmann::ordered_json documents = nlohmann::ordered_json::array();
  bool first = true;
  for (const Quantity& quantity : Quantities()) {
    if (!verb.quantity.empty() && &quantity != &Find(verb.quantity)) continue;
    if (json) {
      documents.push_back(Document(quantity));
      continue;
    }
    if (!first) fmt::print("\n");
    Describe(quantity);
    first = false;
  }
  if (json) fmt::print("{}\n", nlohmann::ordered_json{{"quantities", documents}}.dump(2));
}

int RunEval(const EvalVerb& verb, const CommonOptions& common) {
  if (verb.list) {
    List(verb, common.json);
    return kExitDone;
  }
  if (verb.quantity.empty()) {
    throw UsageError("eval needs the name of a quantity; `lobefit eval --list` describes all of them");
  }
  if (common.json) throw UsageError("--json goes with --list only: the results of eval are CSV");
  EvaluateStream(Find(verb.quantity), stdin, stdout);
  return kExitDone;
}

}  // namespace

std::function<int()> SetUpEval(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<EvalVerb>();
  app->add_option("QUANTITY", verb->quantity,
                  "the quantity to evaluate for each row of the CSV on stdin; its columns are found by name, columns "
                  "that it does not know pass through, its results are appended to the row on stdout");
  app->add_flag("--list", verb->list, "describe the quantity, or all: columns, units, domains and source");
  return [=] { return RunEval(*verb, *common); };
}

}  // namespace lobefit
