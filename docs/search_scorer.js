// Pages before names: a name of the program counts less than a page that has the word.
var Scorer = {
  objNameMatch: 4,
  objPartialMatch: 1,
  objPrio: { 0: 0, 1: 0, 2: -3 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
  score: ([page, , , , score]) => {
    if (/^(how-to|tutorials|explanation)\/(?!index)/.test(page)) return score + 6;
    return /^(reference\/api|gallery|about)\//.test(page) ? score - 12 : score;
  },
};
