//! The scenes that there are: their names, their parameters, what makes them.

use super::assembly::Assembly;
use super::values::{Choice, Parameter, Values};
use super::{arena, chess, cornell, desk, fence, hall, lamps, office, panel, power, shirley, specimen, zone_plate};

/// A scene that the program can make.
pub struct BuiltIn {
    pub name: &'static str,
    /// One line.
    pub description: &'static str,
    pub parameters: &'static [Parameter],
    pub(super) make: fn(&Values, u64) -> Assembly,
}

/// All of them, in the order in which help lists them.
pub const ALL: &[BuiltIn] = &[
    BuiltIn {
        name: "cornell",
        description: "the Cornell box: two blocks, a red and a green wall, a panel in the ceiling",
        parameters: &[Parameter {
            key: "motion",
            description: "whether its panel and its lamp circle under the ceiling",
            choice: Choice::Switch,
        }],
        make: cornell::make,
    },
    BuiltIn {
        name: "hall",
        description: "a vaulted hall of fluted columns, inside: marble, brick, brass, glass, and lamps",
        parameters: &[
            Parameter {
                key: "triangles",
                description: "number of triangles of all draws together, within 5 %",
                choice: Choice::Number { default: 256_000, range: [hall::LEAST_TRIANGLES, 4_000_000] },
            },
            Parameter {
                key: "lights",
                description: "number of its lamps that are there",
                choice: Choice::Number { default: hall::MOST_LAMPS, range: [1, hall::MOST_LAMPS] },
            },
            Parameter {
                key: "draws",
                description: "greatest number of draws, with copies joined to one mesh",
                choice: Choice::Number { default: hall::MOST_DRAWS, range: [hall::LEAST_DRAWS, hall::MOST_DRAWS] },
            },
        ],
        make: hall::make,
    },
    BuiltIn {
        name: "lamps",
        description: "objects on a plane under many coloured lamps (after Kircher & Lawrance 2009, figure 8)",
        parameters: &[
            Parameter {
                key: "objects",
                description: "number of objects",
                choice: Choice::Number { default: 101, range: [1, 5000] },
            },
            Parameter {
                key: "lights",
                description: "number of point lights",
                choice: Choice::Number { default: 81, range: [0, 5000] },
            },
        ],
        make: lamps::make,
    },
    BuiltIn {
        name: "fence",
        description: "a yard at night behind chain-link: lamps, handrails, layers of glass, a rotor that turns",
        parameters: &[
            Parameter {
                key: "lights",
                description: "number of point lights",
                choice: Choice::Number { default: 122, range: [1, 5000] },
            },
            Parameter { key: "alpha", description: "alpha mode of the wire", choice: Choice::Word(&["blend", "mask"]) },
        ],
        make: fence::make,
    },
    BuiltIn {
        name: "arena",
        description: "a gothic round under 64 spots, with a camera that flies (after Clarberg & Munkberg 2014, table 1)",
        parameters: &[Parameter {
            key: "triangles",
            description: "number of triangles of all draws together, within 1 %",
            choice: Choice::Number { default: 528_000, range: [arena::LEAST_TRIANGLES, 8_000_000] },
        }],
        make: arena::make,
    },
    BuiltIn {
        name: "power",
        description: "a hall of turbines, tanks and pipes in a floodlight (after Clarberg & Munkberg 2014, table 1)",
        parameters: &[Parameter {
            key: "triangles",
            description: "number of triangles of all draws together, within 1 %",
            choice: Choice::Number { default: 111_000, range: [power::LEAST_TRIANGLES, 4_000_000] },
        }],
        make: power::make,
    },
    BuiltIn {
        name: "chess",
        description: "a game of chess under sixteen spots, four men moving (after Clarberg & Munkberg 2014, table 1)",
        parameters: &[Parameter {
            key: "triangles",
            description: "number of triangles of all draws together, within 1 %",
            choice: Choice::Number { default: 46_000, range: [chess::LEAST_TRIANGLES, 2_000_000] },
        }],
        make: chess::make,
    },
    BuiltIn {
        name: "office",
        description: "an office under two panels, with blinds at its window (after Dubla 2009, figure 6)",
        parameters: &[
            Parameter {
                key: "desks",
                description: "number of desks, each with a chair; the room grows with every fourth",
                choice: Choice::Number { default: 4, range: [1, 32] },
            },
            Parameter {
                key: "slats",
                description: "number of slats of each blind",
                choice: Choice::Number { default: 30, range: [6, 300] },
            },
            Parameter { key: "smoke", description: "whether smoke fills the room", choice: Choice::Switch },
        ],
        make: office::make,
    },
    BuiltIn {
        name: "desk",
        description: "a desk lamp over many small things, seen closely: shadows of contact and wide penumbrae",
        parameters: &[Parameter {
            key: "things",
            description: "number of the small things that lie about",
            choice: Choice::Number { default: 26, range: [0, 60] },
        }],
        make: desk::make,
    },
    BuiltIn {
        name: "shirley",
        description: "boxes on tables and on the floor of a room under one panel (after Dubla 2009, figure 6)",
        parameters: &[Parameter {
            key: "boxes",
            description: "number of boxes",
            choice: Choice::Number { default: 72, range: [1, 250] },
        }],
        make: shirley::make,
    },
    BuiltIn {
        name: "specimen",
        description: "a frame of bars around a cube of a metre, for a volume in it (--volume)",
        parameters: &[Parameter {
            key: "rod",
            description: "whether a rod goes through the middle, a surface within the volume",
            choice: Choice::Switch,
        }],
        make: specimen::make,
    },
    BuiltIn {
        name: "panel",
        description: "a flat panel of triangles of one size: what shading rates depend on (after Clarberg 2014, figure 7)",
        parameters: &[Parameter {
            key: "parts",
            description: "number of squares along each of its sides of 0.8 metres, two triangles each; the picture is 1.237 metres high there",
            choice: Choice::Number { default: 100, range: [1, panel::MOST_PARTS] },
        }],
        make: panel::make,
    },
    BuiltIn {
        name: "zone-plate",
        description: "a flat plate of rings whose frequency grows evenly: what samplers alias (after Keller 2001, figure 1)",
        parameters: &[
            Parameter {
                key: "frequency",
                description: "cycles a metre, across, in the middle of the plate, which is a metre high",
                choice: Choice::Number { default: 0, range: [0, zone_plate::MOST_FREQUENCY] },
            },
            Parameter {
                key: "growth",
                description: "how many cycles a metre the frequency grows by for each metre",
                choice: Choice::Number { default: 480, range: [zone_plate::LEAST_GROWTH, zone_plate::MOST_GROWTH] },
            },
        ],
        make: zone_plate::make,
    },
];
