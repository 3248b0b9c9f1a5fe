"""A small building model, written as IFC: two rooms, a room above them, and stairs."""

from pathlib import Path

import ifcopenshell
import ifcopenshell.guid

RISERS, TREAD = 17, 0.27


class House:
    """Writes elements with bodies that are boxes; metres, or millimetres with ``scale`` 1000."""

    def __init__(self, scale=1.0, schema="IFC4"):
        self.model, self.scale = ifcopenshell.file(schema=schema), scale
        prefix = {1.0: None, 1000.0: "MILLI"}[scale]
        unit = self.model.create_entity("IfcSIUnit", None, "LENGTHUNIT", prefix, "METRE")
        self.context = self.model.create_entity(
            "IfcGeometricRepresentationContext",
            ContextIdentifier="Body",
            ContextType="Model",
            CoordinateSpaceDimension=3,
            Precision=1e-5,
            WorldCoordinateSystem=self.axes(0, 0, 0),
        )
        project = self.model.create_entity(
            "IfcProject",
            ifcopenshell.guid.new(),
            Name="house",
            RepresentationContexts=[self.context],
            UnitsInContext=self.model.create_entity("IfcUnitAssignment", [unit]),
        )
        self.building = self.root("IfcBuilding", "Test house")
        self.whole(project, [self.building])

    def root(self, kind, name, **more):
        return self.model.create_entity(kind, ifcopenshell.guid.new(), Name=name, **more)

    def axes(self, x, y, z):
        spot = self.model.create_entity(
            "IfcCartesianPoint", [float(v) * self.scale for v in (x, y, z)]
        )
        return self.model.create_entity("IfcAxis2Placement3D", spot)

    def whole(self, whole, parts):
        self.model.create_entity(
            "IfcRelAggregates",
            ifcopenshell.guid.new(),
            RelatingObject=whole,
            RelatedObjects=parts,
        )

    def storey(self, name, z):
        place = self.model.create_entity("IfcLocalPlacement", None, self.axes(0, 0, z))
        return self.root("IfcBuildingStorey", name, ObjectPlacement=place, Elevation=z * self.scale)

    def box(self, x0, y0, z0, x1, y1, z1):
        make, size = self.model.create_entity, self.scale
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)]
        line = make(
            "IfcPolyline",
            [make("IfcCartesianPoint", [float(v) * size for v in corner]) for corner in corners],
        )
        area = make("IfcArbitraryClosedProfileDef", "AREA", None, line)
        up = make("IfcDirection", [0.0, 0.0, 1.0])
        return make("IfcExtrudedAreaSolid", area, self.axes(0, 0, z0), up, float(z1 - z0) * size)

    def add(self, kind, name, storey, boxes, **more):
        """An element of boxes on a storey; coordinates are those of the world."""
        shape = self.model.create_entity(
            "IfcShapeRepresentation",
            self.context,
            "Body",
            "SweptSolid",
            [self.box(*each) for each in boxes],
        )
        element = self.root(
            kind,
            name,
            ObjectPlacement=self.model.create_entity("IfcLocalPlacement", None, self.axes(0, 0, 0)),
            Representation=self.model.create_entity(
                "IfcProductDefinitionShape", None, None, [shape]
            )
            if boxes
            else None,
            **more,
        )
        if kind == "IfcSpace":
            self.whole(storey, [element])
        elif storey is not None:
            self.model.create_entity(
                "IfcRelContainedInSpatialStructure",
                ifcopenshell.guid.new(),
                RelatedElements=[element],
                RelatingStructure=storey,
            )
        return element

    def stated(self, room, area):
        """Give a room the base quantity of its floor, square metres."""
        make, kind = self.model.create_entity, "BaseQuantities"
        value = make("IfcQuantityArea", "GrossFloorArea", None, None, float(area))
        own = make("IfcElementQuantity", ifcopenshell.guid.new(), None, kind, None, None, [value])
        new = ifcopenshell.guid.new()
        make("IfcRelDefinesByProperties", new, None, None, None, [room], own)

    def door(self, name, storey, wall, box, width):
        """A door in an opening of a wall."""
        opening = self.add("IfcOpeningElement", f"opening of {name}", None, [box])
        door = self.add("IfcDoor", name, storey, [], OverallWidth=width * self.scale)
        make = self.model.create_entity
        make("IfcRelVoidsElement", ifcopenshell.guid.new(), None, None, None, wall, opening)
        make("IfcRelFillsElement", ifcopenshell.guid.new(), None, None, None, opening, door)
        return door


def house_with_a_landing(path: Path) -> Path:
    """Two storeys 3 m apart; stairs lead up 9 risers along x, a landing, and 8 risers along y."""
    made = House()
    ground, upper = made.storey("Ground", 0), made.storey("Upper", 3)
    made.whole(made.building, [ground, upper])
    made.add("IfcSpace", "hall", ground, [(0, 0, 0, 10, 8, 2.7)])
    made.add("IfcSpace", "office", upper, [(0, 0, 3, 10, 8, 5.7)])
    wall = made.add("IfcWall", "west", ground, [(-0.3, 0, 0, 0, 8, 2.7)])
    made.door("Street", ground, wall, (-0.35, 1, 0, 0.05, 2, 2.1), 1.0)
    riser, at = 3 / 17, [(3 + 0.28 * k, 4, 3.28 + 0.28 * k, 5.2) for k in range(8)]
    at += [(5.24, 4, 6.44, 5.2)]
    at += [(5.24, 5.2 + 0.28 * k, 6.44, 5.48 + 0.28 * k) for k in range(7)]
    boxes = [(x0, y0, 0, x1, y1, (k + 1) * riser) for k, (x0, y0, x1, y1) in enumerate(at)]
    made.add("IfcStair", "Corner", ground, boxes)
    made.model.write(str(path))
    return path


def house(path: Path, scale: float = 1.0, schema: str = "IFC4", *, flights: bool = True) -> Path:
    """A house 12 m long: hall and office at 0 m, loft at 3 m, an outer and an inner door."""
    made = House(scale, schema)
    ground, upper = made.storey("Ground", 0), made.storey("Loft", 3)
    roof = made.storey("Roof", 6)
    made.whole(made.building, [ground, upper, roof])
    made.add("IfcSpace", "101", ground, [(0, 0, 0, 8, 5, 2.7)], LongName="Hall")
    office = made.add("IfcSpace", "102", ground, [(8.2, 0, 0, 12, 5, 2.7)], LongName="Office")
    made.stated(office, 21.2)  # to the middle of the walls: 4 m x 5.3 m
    made.add("IfcSpace", "201", upper, [(0, 0, 3, 12, 5, 5.7)], LongName="Loft")
    inner = made.add("IfcWall", "inner", ground, [(8, 0, 0, 8.2, 5, 2.7)])
    west = made.add("IfcWall", "west", ground, [(-0.3, -0.3, 0, 0, 5.3, 2.7)])
    made.add("IfcWall", "east", ground, [(12, -0.3, 0, 12.3, 5.3, 2.7)])
    made.add("IfcWall", "south", ground, [(-0.3, -0.3, 0, 12.3, 0, 2.7)])
    made.add("IfcWall", "north", ground, [(-0.3, 5, 0, 12.3, 5.3, 2.7)])
    made.add("IfcColumn", "column", ground, [(10, 2, 0, 10.5, 2.5, 2.7)])
    high = made.add("IfcWall", "upper", upper, [(12, -0.3, 3, 12.3, 5.3, 5.7)])
    made.door("Family:Type:17", ground, inner, (7.9, 1, 0, 8.3, 1.9, 2.1), 0.9)
    made.door("Street", ground, west, (-0.35, 1.5, 0, 0.05, 2.5, 2.1), 1.0)
    made.door("Balcony", upper, high, (11.9, 1, 3, 12.4, 2, 5.1), 1.0)
    treads = [
        (1.5 + k * TREAD, 3.8, 0, 1.5 + (k + 1) * TREAD, 4.9, (k + 1) * 3 / RISERS)
        for k in range(RISERS - 1)
    ]
    stairs = made.add("IfcStair", "Main", ground, [] if flights else treads)
    if flights:
        risers = {"NumberOfRisers" if schema != "IFC2X3" else "NumberOfRiser": RISERS}
        made.whole(stairs, [made.add("IfcStairFlight", "flight", None, treads, **risers)])
    made.model.write(str(path))
    return path
