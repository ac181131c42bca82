//! Texts that are read, and texts that are refused with the place and what to write.

use super::parser::{Names, condition, number};

const NAMES: Names<'_> = Names {
    usable: &["dT", "V", "c", "n", "windward"],
    flags: &["windward"],
    absent: &[("Ts", "Write dT.")],
};

fn value(text: &str) -> f64 {
    match number(text, NAMES) {
        Ok(tree) => tree.value(&[-8.0, 3.0, 2.0, 0.5, 1.0]),
        Err(fault) => panic!("{text}: {fault}"),
    }
}

#[test]
fn values_by_hand() {
    for (text, expected) in [
        ("1 + 2*3^2", 19.0),
        ("-2^2", -4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("2**3", 8.0),
        ("(1 + 2)*3", 9.0),
        ("6/3/2", 1.0),
        ("7 - 2 - 1", 4.0),
        ("1.5e1 + .5", 15.5),
        ("abs(dT)^(1/3)", 2.0),
        ("max(1, V, 2) - min(dT, 0)", 11.0),
        ("if(dT < 0, 1, 2)", 1.0),
        ("if(not dT < 0 or V >= 3, 1, 2)", 1.0),
        ("if((dT < 0 and V < 3) or (V > 5), 1, 2)", 2.0),
        ("if(-10 < dT <= -8, 1, 2)", 1.0),
        ("if(windward, 4, 5)", 4.0),
        ("sqrt(16) + log(exp(2)) + cos(0) + sin(0) + tanh(0) + log10(100) + cbrt(27)", 12.0),
        ("2*pi/pi", 2.0),
        ("c*\n  n", 1.0),
    ] {
        assert!((value(text) - expected).abs() < 1e-12, "{text} is {}", value(text));
    }
    let holds = condition("abs(dT) < 30 and (V < 10)", NAMES).unwrap();
    assert!(holds.holds(&[29.0, 3.0, 0.0, 0.0, 0.0]) && !holds.holds(&[29.0, 10.0, 0.0, 0.0, 0.0]));
}

#[test]
fn faults_have_a_place_and_a_remedy() {
    for (text, column, words) in [
        ("", 1, "Write one"),
        ("2.3*abs(dT", 11, "Close the bracket of column 8"),
        ("2.3*abs(dT))", 12, "Remove this bracket"),
        ("2,3*dT", 2, "decimals with a point"),
        ("abs(dT)^(1,3)", 11, "decimals with a point"),
        ("2.3 dT", 5, "Write * for a product"),
        ("2dT", 1, "Write 2*d"),
        ("2.3·dT", 4, "Write * for a product"),
        ("|dT|^0.3", 1, "abs(x)"),
        ("h*2", 1, "the name 'h'"),
        ("2 = 3", 3, "no equals sign"),
        ("2 + ", 5, "Something is missing"),
        ("2 + *3", 5, "found '*'"),
        ("foo(dT)", 1, "The functions are abs"),
        ("c(2)", 1, "Write c*(...)"),
        ("Ts - 2", 1, "Write dT."),
        ("dTT^2", 1, "correct the name"),
        ("if(dT, 1, 2)", 4, "Compare it"),
        ("if(dT < 0, 1)", 13, "Write if("),
        ("dT < 3", 4, "Write if(a < b, x, y)"),
        ("max(2)", 1, "Write max(a, b)"),
        ("sqrt 2", 6, "Write sqrt(...)"),
        ("1e999", 1, "a number"),
        ("1..2", 1, "a sign after"),
        ("c*\n abs(q)", 6, "the name 'q'"),
    ] {
        let fault = number(text, NAMES).unwrap_err();
        assert!(fault.at.column == column && fault.to_string().contains(words), "{text}: {fault}");
    }
    let fault = number("c*\n abs(q)", NAMES).unwrap_err();
    assert_eq!(fault.at.line, 2);
    assert!(condition("abs(dT)", NAMES).unwrap_err().to_string().contains("abs(dT) < 30"));
    assert!(number(&"(".repeat(3000), NAMES).is_err() && number(&"-".repeat(1000), NAMES).is_err());
    assert!(number(&format!("{}1{}", "(".repeat(900), ")".repeat(900)), NAMES).is_err());
}
